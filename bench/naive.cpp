// SPDX-License-Identifier: MIT
// `scarp-bench naive`: the comparison of the max-mip article, 55.066 ms without and 9.074 ms with the pyramid, made
// fair: naive marching is first tuned to have the positions of the hits at the least cost (naive_search.h), then timed.
// Weaker criteria are measured beside it.
#include <fmt/format.h>

#include <cstdio>
#include <functional>
#include <optional>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/fields.h"
#include "bench/judge.h"
#include "bench/naive_search.h"
#include "bench/protocol.h"
#include "bench/rays.h"
#include "bench/report.h"
#include "bench/scarp_engine.h"
#include "bench/trace_options.h"

namespace scarp::bench {
namespace {

// `naive`: the comparison of the max-mip article, with naive marching fine enough to be correct.
struct NaiveOptions {
  TraceOptions trace;
  double miss_limit = 0.001;  // fraction of the judge's hits that naive may miss or have elsewhere
};

using Json = nlohmann::ordered_json;

// The mode in which naive has the positions of the hits.
constexpr const char* kPosition = "naive-position";

struct Contender {
  Engine engine;
  std::optional<NaiveSettings> settings;  // nullopt: max-mip
  Judgement judged;
};

Contender naive_with(const ScarpGround& scarp, const Judge& judge, const char* mode, const NaiveSettings& settings) {
  MarchSettings all;
  all.naive = settings;
  Contender contender{scarp.engine(find_height_march("naive"), all), settings, {}};
  contender.engine.mode = mode;
  contender.judged = judge.judge(contender.engine);
  return contender;
}

std::optional<Contender> cheapest(const ScarpGround& scarp, const Judge& judge, const char* mode,
                                  const std::function<bool(const Judgement&)>& good,
                                  EarlyHits early = EarlyHits::limited) {
  const auto attempt = [&](const NaiveSettings& tried) {
    const Judgement judged = naive_with(scarp, judge, mode, tried).judged;
    return NaiveTrial{good(judged), judged.steps};
  };
  const auto settings = cheapest_naive(attempt);
  if (!settings) return {};
  return naive_with(scarp, judge, mode, coarsened_naive(*settings, attempt, early));
}

class Comparison {
 public:
  explicit Comparison(const NaiveOptions& options) : options_(options) {}

  void run(const BenchField& ground, double exaggeration) {
    const ScarpGround scarp(ground.field);
    const TraceOptions& trace = options_.trace;
    const double limit = options_.miss_limit;
    for (const RaySet& set :
         make_rays(ground, {RayClass::primary, RayClass::shadow, RayClass::chunk, RayClass::grazing}, trace.rays,
                   trace.ray_seed)) {
      // The search takes minutes, and the table comes last.
      fmt::print(stderr, "exaggeration {}, class {}\n", exaggeration, name_of(set.ray_class));
      const Judge judge(scarp.target(), set, trace.judged, trace.ray_seed);
      std::vector<Contender> contenders{{scarp.engine(find_height_march("max-mip")), std::nullopt, {}},
                                        {scarp.vectors("max-mip-simd"), std::nullopt, {}}};
      for (Contender& max_mip : contenders) max_mip.judged = judge.judge(max_mip.engine);
      contenders.push_back(naive_with(scarp, judge, "naive-default", {}));
      const auto add = [&](std::optional<Contender> contender) {
        if (contender) contenders.push_back(std::move(*contender));
      };
      // The comparison: ground that was stepped over counts as a hole, even if something is hit behind it, and so does
      // a hit in the air.
      add(cheapest(scarp, judge, kPosition, [&](const Judgement& j) { return has_positions(j, limit); }));
      add(cheapest(
          scarp, judge, "naive-missed", [&](const Judgement& j) { return j.miss_rate < limit; }, EarlyHits::ignored));
      if (set.any_hit) {
        // A false shadow is as wrong as a missing one.
        add(cheapest(scarp, judge, "naive-missed-false",
                     [&](const Judgement& j) { return j.miss_rate + j.false_rate < limit; }));
      }
      add(cheapest(
          scarp, judge, "naive-missed-late", [&](const Judgement& j) { return j.miss_rate + j.late_rate < limit; },
          EarlyHits::ignored));
      for (const int threads : trace.threads) measure_all(ground, exaggeration, set, contenders, threads);
    }
  }

  const Json& rows() const { return rows_; }

  void print() const {
    std::vector<std::vector<std::string>> lines{{"class", "mode", "exagg.", "thr", "factor", "least step", "Mrays/s",
                                                 "max-mip is", "in vectors", "missed %", "late %", "early %", "false %",
                                                 "error p99", "steps", "given up %", "busy"}};
    const auto percent = [](const Json& share) { return short_number(100 * share.get<double>()); };
    for (const Json& row : rows_) {
      lines.push_back({row["class"], row["mode"], short_number(row["exaggeration"]), short_number(row["threads"]),
                       short_number(row["step_factor"]),
                       row["min_step"].is_null() ? "-" : fmt::format("1/{:.0f}", 1 / row["min_step"].get<double>()),
                       short_number(row["mrays_per_s"]), fmt::format("{:.2f} x", row["max_mip_ratio"].get<double>()),
                       fmt::format("{:.2f} x", row["max_mip_simd_ratio"].get<double>()), percent(row["miss_rate"]),
                       percent(row["late_rate"]), percent(row["early_rate"]), percent(row["false_rate"]),
                       short_number(row["error_p99"], 2), short_number(row["steps_per_ray"]), percent(row["exhausted"]),
                       fmt::format("{:.2f}", row["busy"].get<double>())});
    }
    print_table(lines, 2);
    print_comparison();
  }

 private:
  void print_comparison() const {
    std::vector<std::vector<std::string>> lines{{"class", "exagg.", "thr", "max-mip is", "in vectors"}};
    for (const Json& row : rows_) {
      if (row["mode"] != kPosition) continue;
      lines.push_back({row["class"], short_number(row["exaggeration"]), short_number(row["threads"]),
                       fmt::format("{:.2f} x", row["max_mip_ratio"].get<double>()),
                       fmt::format("{:.2f} x", row["max_mip_simd_ratio"].get<double>())});
    }
    fmt::print("naive with at most {} % of its hits lost or more than a cell off ({}):\n", 100 * options_.miss_limit,
               kPosition);
    print_table(lines, 1);
  }

  void measure_all(const BenchField& ground, double exaggeration, const RaySet& set,
                   const std::vector<Contender>& contenders, int threads) {
    std::vector<Engine> engines;
    for (const Contender& contender : contenders) engines.push_back(contender.engine);
    const auto timings = measure(engines, set, {threads, options_.trace.repeats, options_.trace.pass_limit_s});
    for (std::size_t e = 0; e < engines.size(); ++e) {
      const auto& [engine, settings, judged] = contenders[e];
      const Timing& timing = timings[e];
      Json row;
      row["size"] = ground.field.cols();
      row["class"] = name_of(set.ray_class);
      row["engine"] = engine.name;
      row["mode"] = engine.mode;
      row["threads"] = threads;
      row["exaggeration"] = exaggeration;
      row["mrays_per_s"] = timing.mrays_per_s;
      row["mrays_per_cpu_s"] = timing.mrays_per_cpu_s;
      row["max_mip_ratio"] = timings[0].mrays_per_cpu_s / timing.mrays_per_cpu_s;
      row["max_mip_simd_ratio"] = timings[1].mrays_per_cpu_s / timing.mrays_per_cpu_s;
      row["article_ratio"] = kArticleRatio;
      row["step_factor"] = settings ? Json(settings->step_factor) : Json();
      row["min_step"] = settings ? Json(settings->min_step) : Json();
      row["tolerance"] = settings ? Json(settings->tolerance) : Json();
      row["miss_rate"] = judged.miss_rate;
      row["late_rate"] = judged.late_rate;
      row["early_rate"] = judged.early_rate;
      row["false_rate"] = judged.false_rate;
      row["error_p99"] = judged.error_p99 ? Json(*judged.error_p99) : Json();
      row["exhausted"] = judged.exhausted;
      row["steps_per_ray"] = judged.steps;
      row["judged"] = judged.judged;
      row["rays"] = timing.rays;
      row["spread"] = timing.spread;
      row["busy"] = timing.busy;
      row["field"] = ground.name;
      row["relief"] = ground.relief;
      row["mean_slope_deg"] = ground.mean_slope_deg;
      rows_.push_back(std::move(row));
    }
  }

  const NaiveOptions& options_;
  Json rows_ = Json::array();
};

void run_naive(const NaiveOptions& options, const ReportOptions& report) {
  const BenchField ground = load_field(options.trace.field);
  fmt::print("{} x {} samples, {}: relief {:.1f} cells, mean slope {:.1f} degrees\n", ground.field.cols(),
             ground.field.rows(), ground.name, ground.relief, ground.mean_slope_deg);
  std::fflush(stdout);
  Comparison comparison(options);
  for (const double exaggeration : options.trace.exaggerations)
    comparison.run(exaggerated(ground, exaggeration), exaggeration);
  comparison.print();
  fmt::print("the article: 55.066 ms without, 9.074 ms with the pyramid: {:.2f} x\n", kArticleRatio);
  write_json(report, comparison.rows());
}

}  // namespace

void add_naive(cli::Program& program) {
  auto [command, o] = add_command<NaiveOptions>(
      program, "naive", "The max-mip article's comparison, at equal error of position", run_naive);
  o.trace.exaggerations = {1, 4, 16};
  add_size_option(command, o.trace.field.size);
  command.add(
      &o.miss_limit,
      {.names = "--miss-limit", .help = "share of the hits that naive may miss, or have elsewhere", .range = {0, 1}});
  add_trace_options(command, o.trace);
}

}  // namespace scarp::bench
