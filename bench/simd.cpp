// SPDX-License-Identifier: MIT
// `scarp-bench simd`: the gain of the vectors over the scalar walk, and the contribution of each optimisation.
#include <fmt/format.h>

#include <cstdio>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/fields.h"
#include "bench/protocol.h"
#include "bench/rays.h"
#include "bench/report.h"
#include "bench/scarp_engine.h"
#include "bench/trace_options.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/max_mip_simd.h"

namespace scarp::bench {
namespace {

// `simd`: the vectors compared with the scalar walk, on one thread, with each optimisation disabled in turn.
struct SimdOptions {
  TraceOptions trace;
  std::vector<std::string> classes{"primary", "shadow", "grazing", "ao", "nodes"};
};

using Json = nlohmann::ordered_json;

struct Variant {
  const char* name;
  VectorOptions options;
};
const Variant kVariants[] = {
    {"all", {}},
    {"no-refill", {.refill = false}},
    {"no-wait", {.wait = false}},
    {"no-doubles", {.doubles = false}},
    {"no-put-off", {.put_off = false}},
    {"no-find-hits", {.find_hits = false}},
    {"no-beam", {.beam = false}},
    {"no-together", {.together = false}},
    {"none", {.refill = false, .wait = false, .doubles = false, .put_off = false, .find_hits = false, .beam = false}},
};

// Counters of a pass over all rays, and the number of answers that differ from the scalar walk.
struct Count {
  VectorStats stats;
  std::int64_t different = 0;
};
Count count(const Engine& engine, const Engine& scalar, const RaySet& set) {
  constexpr std::int64_t kBlock = 4096;
  std::vector<float> answers(kBlock), expected(kBlock);
  Count count;
  take_vector_stats();
  for (std::int64_t begin = 0; begin < set.size(); begin += kBlock) {
    const std::int64_t end = std::min(begin + kBlock, set.size());
    engine.trace(set, begin, end, answers.data());
    scalar.trace(set, begin, end, expected.data());
    for (std::size_t i = 0; i < static_cast<std::size_t>(end - begin); ++i)
      count.different += answers[i] != expected[i];
  }
  count.stats = take_vector_stats();
  return count;
}

void compare(const BenchField& ground, double exaggeration, const std::vector<RayClass>& classes,
             const SimdOptions& options, Json& rows) {
  const ScarpGround scarp(ground.field);
  std::vector<Engine> engines{scarp.engine(find_height_march("max-mip"))};
  for (const Variant& variant : kVariants) engines.push_back(scarp.vectors(variant.name, variant.options));
  for (const RaySet& set : make_rays(ground, classes, options.trace.rays, options.trace.ray_seed)) {
    const auto timings = measure(engines, set, {1, options.trace.repeats, options.trace.pass_limit_s});
    std::vector<std::vector<std::string>> lines{{"class", "exagg.", "ideas", "Mrays/cpu s", "x scalar", "blocks", "use",
                                                 "cells", "use", "handed over %", "different"}};
    for (std::size_t e = 0; e < engines.size(); ++e) {
      const Count counted = count(engines[e], engines[0], set);
      const double rays = static_cast<double>(set.size());
      const auto share = [](std::uint64_t part, std::uint64_t of) {
        return of > 0 ? static_cast<double>(part) / static_cast<double>(of) : 0.0;
      };
      Json row;
      row["class"] = name_of(set.ray_class);
      row["exaggeration"] = exaggeration;
      row["ideas"] = e == 0 ? "scalar" : engines[e].mode;
      row["mrays_per_cpu_s"] = timings[e].mrays_per_cpu_s;
      row["scalar_ratio"] = timings[e].mrays_per_cpu_s / timings[0].mrays_per_cpu_s;
      row["blocks_per_ray"] = static_cast<double>(counted.stats.block_lanes) / rays;
      row["block_lanes_used"] = share(counted.stats.block_lanes, counted.stats.block_steps);
      row["cells_per_ray"] = static_cast<double>(counted.stats.cell_lanes) / rays;
      row["cell_lanes_used"] = share(counted.stats.cell_lanes, counted.stats.cell_steps);
      row["handed_over"] = static_cast<double>(counted.stats.handed_over) / rays;
      row["different"] = counted.different;
      row["busy"] = timings[e].busy;
      row["field"] = ground.name;
      row["size"] = ground.field.cols();
      lines.push_back({row["class"], short_number(exaggeration), row["ideas"], short_number(row["mrays_per_cpu_s"]),
                       fmt::format("{:.2f}", row["scalar_ratio"].get<double>()), short_number(row["blocks_per_ray"]),
                       short_number(row["block_lanes_used"]), short_number(row["cells_per_ray"]),
                       short_number(row["cell_lanes_used"]),
                       fmt::format("{:.2f}", 100 * row["handed_over"].get<double>()), short_number(row["different"])});
      rows.push_back(std::move(row));
    }
    print_table(lines, 3);
    std::fflush(stdout);
  }
}

void run_simd(const SimdOptions& options, const ReportOptions& report) {
  std::vector<RayClass> classes;
  for (const std::string& name : options.classes) classes.push_back(find_ray_class(name));
  const BenchField ground = load_field(options.trace.field);
  Json rows = Json::array();
  for (const double exaggeration : options.trace.exaggerations)
    compare(exaggerated(ground, exaggeration), exaggeration, classes, options, rows);
  write_json(report, rows);
}

}  // namespace

void add_simd(cli::Program& program) {
  std::vector<std::string> classes;
  for (const RayClass ray_class : kRayClasses) classes.emplace_back(name_of(ray_class));
  auto [command, o] = add_command<SimdOptions>(
      program, "simd", "The vectors beside the scalar walk, and what each idea gains", run_simd);
  add_size_option(command, o.trace.field.size);
  add_classes_option(command, o.classes, std::move(classes));
  add_trace_options(command, o.trace);
}

}  // namespace scarp::bench
