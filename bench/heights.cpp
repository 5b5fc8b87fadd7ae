// SPDX-License-Identifier: MIT
// `scarp-bench heights`: all marches and Embree, several classes of rays, in one run.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "bench/bullet_peer.h"
#include "bench/command.h"
#include "bench/commands.h"
#include "bench/embree_peer.h"
#include "bench/fields.h"
#include "bench/instruction_set.h"
#include "bench/judge.h"
#include "bench/protocol.h"
#include "bench/rays.h"
#include "bench/report.h"
#include "bench/scarp_engine.h"
#include "bench/trace_options.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp::bench {
namespace {

// `heights`: all marches and all modes of Embree, in several ray classes.
struct HeightsOptions {
  TraceOptions trace;
  std::vector<int> sizes{2049};
  std::vector<std::string> classes{"primary", "shadow",       "grazing", "ao",     "nodes",
                                   "lidar",   "lidar-ground", "near",    "lidar64"};
  std::vector<std::string> marches;  // modes of scarp, as rows name them; empty: all
  std::vector<std::string> engines{"scarp", "embree-tri", "embree-grid"};  // and "bullet", which is slow
  std::string embree_quality = "high";
};

using Json = nlohmann::ordered_json;

// Embree's triangles take about 210 bytes per sample while they are built; fields that would need more than 8 GB are
// measured without them.
constexpr double kTriangleBytes = 210, kMostTriangleBytes = 8e9;
bool has_room_for_triangles(const HeightField& field) {
  const double bytes = kTriangleBytes * field.cols() * field.rows();
  if (bytes <= kMostTriangleBytes) return true;
  fmt::print("embree-tri is left out over {} x {} samples: building it would take {:.0f} GB\n", field.cols(),
             field.rows(), bytes * 1e-9);
  return false;
}

// All engines over one field.
class Contest {
 public:
  Contest(const BenchField& ground, const HeightsOptions& options) : scarp_(ground.field) {
    const EmbreeQuality quality = find_embree_quality(options.embree_quality);
    for (const std::string& name : options.engines) {
      if (name == "scarp") {
        for (Engine& engine : scarp_.engines()) {
          const auto& wanted = options.marches;
          if (wanted.empty() || std::find(wanted.begin(), wanted.end(), engine.mode) != wanted.end())
            engines_.push_back(std::move(engine));
        }
      } else if (name == "embree-tri") {
        if (!has_room_for_triangles(ground.field)) continue;
        add_embree(ground.field, EmbreeSurface::triangles, quality);
      } else if (name == "embree-grid") {
        add_embree(ground.field, EmbreeSurface::grid, quality);
      } else if (name == "bullet") {
        for (const bool accelerated : {true, false})
          add({bullets_.emplace_back(std::make_unique<BulletPeer>(ground.field, accelerated))->engine()});
      } else {
        throw Error(fmt::format("engine '{}': unknown (available: scarp, embree-tri, embree-grid, bullet)", name));
      }
    }
  }

  const std::vector<Engine>& engines() const { return engines_; }
  HeightTarget target() const { return scarp_.target(); }

 private:
  void add(std::vector<Engine> engines) {
    for (Engine& engine : engines) engines_.push_back(std::move(engine));
  }

  void add_embree(const HeightField& field, EmbreeSurface surface, EmbreeQuality quality) {
    for (const bool robust : {true, false})
      add(embrees_.emplace_back(std::make_unique<EmbreePeer>(field, surface, quality, robust))->engines());
  }

  ScarpGround scarp_;
  std::vector<std::unique_ptr<EmbreePeer>> embrees_;
  std::vector<std::unique_ptr<BulletPeer>> bullets_;
  std::vector<Engine> engines_;
};

Json row_of(const Engine& engine, const RaySet& set, const Timing& timing, const std::optional<Judgement>& judged,
            const HeightField& field) {
  const double samples = static_cast<double>(field.cols()) * field.rows();
  Json row;
  row["class"] = name_of(set.ray_class);
  row["engine"] = engine.name;
  row["mode"] = engine.mode;
  row["mrays_per_s"] = timing.mrays_per_s;
  row["mrays_per_cpu_s"] = timing.mrays_per_cpu_s;
  row["bytes_per_sample"] = engine.bytes / samples;
  row["peak_bytes_per_sample"] = engine.peak_bytes / samples;
  row["build_s"] = engine.build_s;
  row["lost"] = set.must_hit ? Json(timing.rays - timing.hits) : Json();
  row["miss_rate"] = judged ? Json(judged->miss_rate) : Json();
  row["false_rate"] = judged ? Json(judged->false_rate) : Json();
  row["error_p99"] = judged && judged->error_p99 ? Json(*judged->error_p99) : Json();
  row["late_rate"] = judged ? Json(judged->late_rate) : Json();
  row["early_rate"] = judged ? Json(judged->early_rate) : Json();
  row["exhausted"] = judged ? Json(judged->exhausted) : Json();
  row["steps_per_ray"] = judged ? Json(judged->steps) : Json();
  row["cell_tests_per_ray"] = judged ? Json(judged->cell_tests) : Json();
  row["judged"] = judged ? Json(judged->judged) : Json();
  row["rays"] = timing.rays;
  row["hit_share"] = static_cast<double>(timing.hits) / static_cast<double>(timing.rays);
  row["spread"] = timing.spread;
  row["busy"] = timing.busy;
  row["in_full"] = timing.in_full;
  return row;
}

bool is_embree(const Json& row) { return row["engine"].get<std::string>().starts_with("embree"); }

// Adds ratios of processor time to Embree's triangles with single rays, and to the fastest fully measured mode of
// Embree.
void add_ratios(std::vector<Json>& rows) {
  const Json* fastest = nullptr;
  const Json* single = nullptr;
  const auto speed = [](const Json& row) { return row["mrays_per_cpu_s"].get<double>(); };
  for (const Json& row : rows) {
    if (row["engine"] == "embree-tri" && row["mode"] == "x1") single = &row;
    if (is_embree(row) && row["in_full"] && (!fastest || speed(row) > speed(*fastest))) fastest = &row;
  }
  const double tri_x1 = single ? speed(*single) : 0, best = fastest ? speed(*fastest) : 0;
  const Json name =
      fastest ? Json((*fastest)["engine"].get<std::string>() + " " + (*fastest)["mode"].get<std::string>()) : Json();
  for (Json& row : rows) {
    row["x_tri_x1"] = single ? Json(speed(row) / tri_x1) : Json();
    row["x_fastest_embree"] = fastest ? Json(speed(row) / best) : Json();
    row["fastest_embree"] = name;
  }
}

void print(const std::vector<Json>& rows) {
  std::vector<std::vector<std::string>> lines{{"class", "engine", "mode", "Mrays/s", "x tri x1", "x fastest Embree",
                                               "busy", "B/sample", "build s", "hits %", "lost", "missed %", "false %",
                                               "error p99", "steps", "rays"}};
  const auto percent = [](const Json& share) {
    return share.is_null() ? std::string("-") : short_number(100 * share.get<double>());
  };
  const auto ratio = [](const Json& value) {
    return value.is_null() ? std::string("-") : fmt::format("{:.2f}", value.get<double>());
  };
  std::size_t left_out = 0;
  for (const Json& row : rows) {
    if (!row["in_full"]) {
      ++left_out;
      continue;
    }
    const double speed = row["mrays_per_s"];
    lines.push_back({row["class"], row["engine"], row["mode"], short_number(speed), ratio(row["x_tri_x1"]),
                     ratio(row["x_fastest_embree"]), fmt::format("{:.2f}", row["busy"].get<double>()),
                     short_number(row["bytes_per_sample"]), short_number(row["build_s"]),
                     fmt::format("{:.3f}", 100 * row["hit_share"].get<double>()), short_number(row["lost"]),
                     percent(row["miss_rate"]), percent(row["false_rate"]), short_number(row["error_p99"], 2),
                     short_number(row["steps_per_ray"]), short_number(row["rays"])});
  }
  print_table(lines, 3);
  if (left_out > 0) {
    fmt::print("fastest of Embree: {}; {} other modes were slower in a short trial\n",
               rows.front()["fastest_embree"].get<std::string>(), left_out);
  }
}

// Prints the memory that tracing needs, once per structure.
void print_memory(const std::vector<Engine>& engines, const HeightField& field) {
  std::vector<std::string> said;
  for (const Engine& engine : engines) {
    const std::string who = engine.name == "scarp" ? engine.name + " " + engine.mode : engine.name;
    if (std::find(said.begin(), said.end(), who) != said.end()) continue;
    said.push_back(who);
    fmt::print("{}{}: {:.1f} bytes per sample", said.size() == 1 ? "memory: " : ", ", who,
               engine.bytes / (static_cast<double>(field.cols()) * field.rows()));
  }
  fmt::print("\n");
}

void contest(const BenchField& ground, double exaggeration, const HeightsOptions& options,
             const std::vector<RayClass>& classes, Json& all_rows) {
  const TraceOptions& trace = options.trace;
  const int build_threads = *std::max_element(trace.threads.begin(), trace.threads.end());
  fmt::print(
      "\n{} x {} samples, {}, {}, {}, exaggeration {}: relief {:.1f} cells, mean slope {:.1f} degrees; instruction set "
      "{}\n",
      ground.field.cols(), ground.field.rows(), name_of(ground.field.sample_type()), trace.field.surface, ground.name,
      exaggeration, ground.relief, ground.mean_slope_deg, instruction_set());
  std::fflush(stdout);
  const std::vector<RaySet> sets = make_rays(ground, classes, trace.rays, trace.ray_seed);
  std::optional<Contest> engines;
  {
    const ThreadLimit limit(build_threads);
    engines.emplace(ground, options);
  }
  print_memory(engines->engines(), ground.field);
  for (const RaySet& set : sets) {
    const Judge judge(engines->target(), set, trace.judged, trace.ray_seed);
    std::vector<Engine> suited;
    for (const Engine& engine : engines->engines()) {
      if (!engine.in_fans || !set.fan.empty()) suited.push_back(engine);
    }
    std::vector<std::optional<Judgement>> judged;
    for (const Engine& engine : suited) {
      judged.push_back(engine.in_fans   ? std::optional(judge.judge_fan(engine))
                       : engine.closest ? std::optional(judge.judge(engine))
                                        : std::nullopt);
    }
    for (const int threads : trace.threads) {
      const auto timings = measure_fastest(suited, set, {threads, trace.repeats, trace.pass_limit_s});
      std::vector<Json> rows;
      for (std::size_t e = 0; e < timings.size(); ++e) {
        Json row;
        row["size"] = ground.field.cols();
        row["threads"] = threads;
        row.update(row_of(suited[e], set, timings[e], judged[e], ground.field));
        row["build_threads"] = build_threads;
        row["field"] = ground.name;
        row["exaggeration"] = exaggeration;
        row["relief"] = ground.relief;
        row["mean_slope_deg"] = ground.mean_slope_deg;
        row["samples"] = name_of(ground.field.sample_type());
        row["surface"] = trace.field.surface;
        row["instruction_set"] = instruction_set();
        rows.push_back(std::move(row));
      }
      add_ratios(rows);
      for (const Json& row : rows) all_rows.push_back(row);
      fmt::print("\n{} thread{}\n", threads, threads == 1 ? "" : "s");
      print(rows);
    }
  }
}

void run_heights(const HeightsOptions& options, const ReportOptions& report) {
  hold_to_instruction_set(options.trace.instruction_set);
  std::vector<RayClass> classes;
  for (const std::string& name : options.classes) classes.push_back(find_ray_class(name));
  Json rows = Json::array();
  // A file has its own size.
  const std::vector<int> sizes = options.trace.field.dem.empty() ? options.sizes : std::vector<int>{0};
  for (const int size : sizes) {
    FieldOptions field = options.trace.field;
    field.size = size;
    const BenchField ground = load_field(field);
    for (const double exaggeration : options.trace.exaggerations) {
      contest(exaggerated(ground, exaggeration), exaggeration, options, classes, rows);
    }
  }
  write_json(report, rows);
}

}  // namespace

void add_heights(cli::Program& program) {
  auto [command, o] =
      add_command<HeightsOptions>(program, "heights", "All marches beside all modes of Embree", run_heights);
  add_sizes_option(command, o.sizes);
  add_classes_option(command, o.classes);
  command.add(cli::List<std::string>{&o.engines}, {.names = "--engines",
                                                   .help = "engines to measure",
                                                   .choices = {"scarp", "embree-tri", "embree-grid", "bullet"},
                                                   .closed = true});
  command.add(&o.embree_quality, {.names = "--embree-quality",
                                  .value = "NAME",
                                  .help = "quality of Embree's build",
                                  .choices = {"medium", "high"},
                                  .closed = true});
  command.add(cli::List<std::string>{&o.marches},
              {.names = "--marches", .help = "modes of scarp to measure", .fallback = "all"});
  add_field_options(command, o.trace);
  add_trace_options(command, o.trace);
}

}  // namespace scarp::bench
