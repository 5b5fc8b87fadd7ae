// SPDX-License-Identifier: MIT
// `scarp-bench survey`: one field, one camera and one sun may be a lucky choice. This command runs several and reports
// the median and the worst ratio of Scarp's best mode to the peers' best mode, on the same rays, by processor time.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/embree_peer.h"
#include "bench/fields.h"
#include "bench/instruction_set.h"
#include "bench/protocol.h"
#include "bench/rays.h"
#include "bench/report.h"
#include "bench/scarp_engine.h"
#include "bench/trace_options.h"
#include "scarp/base/error.h"

namespace scarp::bench {
namespace {

// `survey`: Scarp's best mode over its peers' best over several fields, cameras and suns; the median and the worst.
struct SurveyOptions {
  TraceOptions trace;
  std::vector<std::string> kinds{"ridged", "fbm"};
  std::vector<std::string> dems;
  std::vector<std::string> classes{"primary", "shadow", "grazing", "ao", "lidar", "lidar-ground", "near"};
  std::vector<std::string> peers{"embree-tri", "embree-grid"};
};

using Json = nlohmann::ordered_json;

// Low over the south; high over the north-western corner, with the sun behind the camera; close to the ground, with a
// low sun.
const RayView kViews[] = {
    {},
    {"from a high corner", {0.02, 0.98, 0.4}, {0.6, 0.4, 0.5}, 135, 45},
    {"close over the ground", {0.3, 0.3, 0.005}, {0.9, 0.8, 0.3}, 250, 8},
};

class Survey {
 public:
  explicit Survey(const SurveyOptions& options) : options_(options) {
    for (const std::string& name : options.classes) classes_.push_back(find_ray_class(name));
  }

  void run(const BenchField& ground) {
    const ScarpGround scarp(ground.field);
    std::vector<std::unique_ptr<EmbreePeer>> peers;
    std::vector<Engine> engines{scarp.engine(find_height_march("max-mip")), scarp.vectors("max-mip-simd")};
    const std::size_t ours = engines.size();
    for (const std::string& name : options_.peers) {
      const EmbreeSurface surface = name == "embree-grid" ? EmbreeSurface::grid : EmbreeSurface::triangles;
      for (const bool robust : {true, false}) {
        peers.push_back(std::make_unique<EmbreePeer>(ground.field, surface, EmbreeQuality::high, robust));
        for (Engine& engine : peers.back()->engines()) engines.push_back(std::move(engine));
      }
    }
    const TraceOptions& trace = options_.trace;
    for (const RayView& view : kViews) {
      for (const RaySet& set : make_rays(ground, classes_, trace.rays, trace.ray_seed, view)) {
        for (const int threads : trace.threads) {
          const auto timings = measure_fastest(engines, set, {threads, trace.repeats, trace.pass_limit_s});
          add(ground, view, set, threads, engines, timings, ours);
        }
      }
    }
  }

  const Json& rows() const { return rows_; }

  void print() const {
    std::vector<std::vector<std::string>> lines{{"class", "thr", "field", "view", "Scarp's best", "Mrays/cpu s",
                                                 "peers' best", "Mrays/cpu s", "ratio", "busy"}};
    std::map<std::pair<std::string, int>, std::vector<double>> ratios;
    for (const Json& row : rows_) {
      const double ratio = row["ratio"];
      ratios[{row["class"], row["threads"]}].push_back(ratio);
      lines.push_back({row["class"], short_number(row["threads"]), row["field"], row["view"], row["scarp_mode"],
                       short_number(row["scarp_mrays_per_cpu_s"]),
                       row["peer"].get<std::string>() + " " + row["peer_mode"].get<std::string>(),
                       short_number(row["peer_mrays_per_cpu_s"]), fmt::format("{:.2f}", ratio),
                       fmt::format("{:.2f}", row["busy"].get<double>())});
    }
    print_table(lines, 5);
    std::vector<std::vector<std::string>> summary{{"class", "thr", "median", "worst", "best", "of"}};
    for (const auto& [key, values] : ratios) {
      const auto [least, most] = std::minmax_element(values.begin(), values.end());
      summary.push_back({key.first, std::to_string(key.second), fmt::format("{:.2f}", median(values)),
                         fmt::format("{:.2f}", *least), fmt::format("{:.2f}", *most), std::to_string(values.size())});
    }
    fmt::print("\nScarp's best mode over the peers' best\n");
    print_table(summary, 1);
  }

 private:
  void add(const BenchField& ground, const RayView& view, const RaySet& set, int threads,
           const std::vector<Engine>& engines, const std::vector<Timing>& timings, std::size_t ours) {
    const auto best = [&](std::size_t begin, std::size_t end) {
      const auto speed = [](const Timing& a) { return a.in_full ? a.mrays_per_cpu_s : 0; };
      const auto faster = [&](const Timing& a, const Timing& b) { return speed(a) < speed(b); };
      const auto at = [&](std::size_t i) { return timings.begin() + static_cast<std::ptrdiff_t>(i); };
      return static_cast<std::size_t>(std::max_element(at(begin), at(end), faster) - timings.begin());
    };
    const std::size_t scarp = best(0, ours), peer = best(ours, engines.size());
    double busy = 1;
    for (const Timing& timing : timings) busy = std::min(busy, timing.busy);
    Json row;
    row["size"] = ground.field.cols();
    row["field"] = ground.name;
    row["view"] = view.name;
    row["class"] = name_of(set.ray_class);
    row["threads"] = threads;
    row["rays"] = set.size();
    row["hit_share"] = static_cast<double>(timings[scarp].hits) / static_cast<double>(timings[scarp].rays);
    row["scarp_mode"] = engines[scarp].mode;
    row["scarp_mrays_per_cpu_s"] = timings[scarp].mrays_per_cpu_s;
    row["peer"] = engines[peer].name;
    row["peer_mode"] = engines[peer].mode;
    row["peer_mrays_per_cpu_s"] = timings[peer].mrays_per_cpu_s;
    row["ratio"] = timings[scarp].mrays_per_cpu_s / timings[peer].mrays_per_cpu_s;
    row["busy"] = busy;
    row["relief"] = ground.relief;
    row["mean_slope_deg"] = ground.mean_slope_deg;
    row["samples"] = name_of(ground.field.sample_type());
    row["surface"] = options_.trace.field.surface;
    row["instruction_set"] = instruction_set();
    rows_.push_back(std::move(row));
  }

  const SurveyOptions& options_;
  std::vector<RayClass> classes_;
  Json rows_ = Json::array();
};

void run_survey(const SurveyOptions& options, const ReportOptions& report) {
  hold_to_instruction_set(options.trace.instruction_set);
  Survey survey(options);
  FieldOptions field = options.trace.field;
  // Read first, so that unreadable files fail immediately.
  std::vector<BenchField> files;
  for (const std::string& dem : options.dems) {
    field.dem = dem;
    files.push_back(load_field(field));
  }
  field.dem.clear();
  for (const std::string& kind : options.kinds) {
    field.kind = kind;
    survey.run(load_field(field));
  }
  for (const BenchField& file : files) survey.run(file);
  survey.print();
  write_json(report, survey.rows());
}

}  // namespace

void add_survey(cli::Program& program) {
  auto [command, o] = add_command<SurveyOptions>(
      program, "survey", "Scarp over Embree in several fields, from several cameras: median and worst", run_survey);
  add_size_option(command, o.trace.field.size, "samples per side of the procedural DEMs");
  command.add(cli::List<std::string>{&o.kinds},
              {.names = "--kinds", .help = "kinds of procedural DEMs", .choices = {"ridged", "fbm"}, .closed = true});
  command.add(cli::List<std::string>{&o.dems},
              {.names = "--dems", .value = "FILE,...", .help = "raster files without holes, too", .files = "*"});
  add_classes_option(command, o.classes);
  command.add(cli::List<std::string>{&o.peers},
              {.names = "--peers", .help = "peers to measure", .choices = o.peers, .closed = true});
  add_field_options(command, o.trace);
  add_measure_options(command, o.trace);
}

}  // namespace scarp::bench
