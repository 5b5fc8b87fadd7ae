// SPDX-License-Identifier: MIT
// `scarp-bench naive`: what the max-mip article compares, 55.066 ms without and 9.074 ms with the pyramid, asked fairly:
// naive marching is first made as fine as it takes to lose fewer than one hit in a thousand, then timed.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include "bench/commands.h"
#include "bench/judge.h"
#include "bench/scarp_engine.h"
#include "scarp/base/error.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kArticleRatio = 55.066 / 9.074;
constexpr double kCoarsestStep = 1.0 / 64, kFinestStep = 1.0 / (1 << 20);
// The height above ground that counts as a hit, against the least step: small enough that what naive reports early stays
// a matter of the step, as its misses are.
constexpr double kTolerancePerStep = 1.0 / 16;

NaiveSettings settings_with(double min_step) {
  NaiveSettings settings;
  settings.min_step = min_step;
  settings.tolerance = kTolerancePerStep * min_step;
  // No ray needs more steps than forced ones alone would take: none is given up.
  settings.max_steps = static_cast<int>(1 / min_step) + 2;
  return settings;
}

// The coarsest least step, halved from kCoarsestStep on, at which naive misses less than the limit.
std::pair<Engine, NaiveSettings> fair_naive(const ScarpGround& scarp, const Judge& judge, double miss_limit) {
  for (double min_step = kCoarsestStep; min_step >= kFinestStep; min_step /= 2) {
    MarchSettings settings;
    settings.naive = settings_with(min_step);
    Engine engine = scarp.engine(find_march("naive"), settings);
    if (judge.judge(engine).miss_rate < miss_limit) return {std::move(engine), settings.naive};
  }
  throw Error(fmt::format("naive: misses {} of the hits or more even at a least step of 2^-20; allow more", miss_limit));
}

}  // namespace

void run_naive(const NaiveOptions& options, const ReportOptions& report) {
  const TraceOptions& trace = options.trace;
  const BenchField ground = load_field(trace.field);
  Json all_rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"class", "mode", "exagg.", "thr", "least step", "Mrays/s", "max-mip is", "missed %",
                                               "false %", "error p99", "steps", "given up %", "busy"}};
  for (const double exaggeration : trace.exaggerations) {
    const BenchField raised = exaggerated(ground, exaggeration);
    const ScarpGround scarp(raised.field);
    for (const RaySet& set : make_rays(raised, {RayClass::primary, RayClass::shadow}, trace.rays, trace.ray_seed)) {
      const Judge judge(scarp.target(), set, trace.judged, trace.ray_seed);
      auto [fair, fair_settings] = fair_naive(scarp, judge, options.miss_limit);
      fair.mode = "naive-fair";
      Engine usual = scarp.engine(find_march("naive"));
      usual.mode = "naive-default";
      const std::vector<Engine> engines{scarp.engine(find_march("max-mip")), usual, fair};
      const std::optional<NaiveSettings> settings[] = {std::nullopt, NaiveSettings{}, fair_settings};
      std::vector<Judgement> judged;
      for (const Engine& engine : engines) judged.push_back(judge.judge(engine));
      for (const int threads : trace.threads) {
        const auto timings = measure(engines, set, {threads, trace.repeats, trace.pass_limit_s});
        for (std::size_t e = 0; e < engines.size(); ++e) {
          const Timing& timing = timings[e];
          const double ratio = timings[0].mrays_per_cpu_s / timing.mrays_per_cpu_s;
          Json row;
          row["size"] = raised.field.cols();
          row["class"] = name_of(set.ray_class);
          row["engine"] = engines[e].name;
          row["mode"] = engines[e].mode;
          row["threads"] = threads;
          row["exaggeration"] = exaggeration;
          row["mrays_per_s"] = timing.mrays_per_s;
          row["mrays_per_cpu_s"] = timing.mrays_per_cpu_s;
          row["max_mip_ratio"] = ratio;
          row["article_ratio"] = kArticleRatio;
          row["min_step"] = settings[e] ? Json(settings[e]->min_step) : Json();
          row["tolerance"] = settings[e] ? Json(settings[e]->tolerance) : Json();
          row["miss_rate"] = judged[e].miss_rate;
          row["false_rate"] = judged[e].false_rate;
          row["error_p99"] = judged[e].error_p99 ? Json(*judged[e].error_p99) : Json();
          row["exhausted"] = judged[e].exhausted;
          row["steps_per_ray"] = judged[e].steps;
          row["judged"] = judged[e].judged;
          row["rays"] = timing.rays;
          row["spread"] = timing.spread;
          row["busy"] = timing.busy;
          row["field"] = raised.name;
          row["relief"] = raised.relief;
          row["mean_slope_deg"] = raised.mean_slope_deg;
          lines.push_back({row["class"], row["mode"], short_number(exaggeration), short_number(threads),
                           settings[e] ? fmt::format("1/{:.0f}", 1 / settings[e]->min_step) : "-", short_number(timing.mrays_per_s),
                           fmt::format("{:.2f} x", ratio), short_number(100 * judged[e].miss_rate),
                           short_number(100 * judged[e].false_rate), short_number(row["error_p99"], 2), short_number(judged[e].steps),
                           short_number(100 * judged[e].exhausted), fmt::format("{:.2f}", timing.busy)});
          all_rows.push_back(std::move(row));
        }
      }
    }
  }
  fmt::print("{} x {} samples, {}: relief {:.1f} cells, mean slope {:.1f} degrees\n", ground.field.cols(), ground.field.rows(),
             ground.name, ground.relief, ground.mean_slope_deg);
  print_table(lines, 2);
  fmt::print("the article: 55.066 ms without, 9.074 ms with the pyramid: {:.2f} x\n", kArticleRatio);
  write_json(report, all_rows);
}

}  // namespace scarp::bench
