// SPDX-License-Identifier: MIT
// `scarp-bench maps`: viewsheds and shadows of all nodes, ns per node and what the sweeps skip, compared with one ray
// each at random nodes; and `scarp` beside other programs that make such maps.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <thread>
#include <utility>
#include <vector>

#include "bench/commands.h"
#include "bench/map_truth.h"
#ifdef SCARP_BENCH_GDAL
#include "bench/map_programs.h"
#endif
#include "scarp/analysis/shadow_sweep.h"
#include "scarp/analysis/sight_rays.h"
#include "scarp/analysis/viewshed_sweep.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/source/procedural_dem.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180;

// `sweep` makes the map anew and returns its statistics.
template <class Sweep>
Json measure_map(const HeightField& field, const char* map, int threads, int repeats, const Sweep& sweep) {
  const ThreadLimit limit(threads);
  std::vector<double> seconds, cpu_seconds;
  SweepStatistics counts;
  for (int repeat = 0; repeat <= repeats; ++repeat) {
    const Stopwatch watch;
    counts = sweep();
    // The first is the warm-up.
    if (repeat == 0) continue;
    seconds.push_back(watch.wall_s());
    cpu_seconds.push_back(watch.cpu_s());
  }
  const double nodes = static_cast<double>(field.cols()) * field.rows(), samples = static_cast<double>(counts.samples);
  Json row;
  row["size"] = field.cols();
  row["map"] = map;
  row["threads"] = threads;
  row["seconds"] = median(seconds);
  row["ns_per_node"] = median(seconds) / nodes * 1e9;
  row["cpu_ns_per_node"] = median(cpu_seconds) / nodes * 1e9;
  row["skipped"] = static_cast<double>(counts.skipped) / samples;
  row["careful"] = static_cast<double>(counts.careful) / samples;
  row["walked"] = static_cast<double>(counts.walked) / samples;
  return row;
}

std::vector<Json> measure_maps(const MapsOptions& options, const HeightField& field, int threads) {
  const auto nodes = static_cast<std::size_t>(field.cols()) * static_cast<std::size_t>(field.rows());
  const Viewpoint view(field, {field.cols() / 2, field.rows() / 2},
                       {.observer_height = static_cast<double>(options.observer_height)});
  const SightGround ground(field);
  const std::vector<scarp::Node> judged = random_nodes(field, options.judged);
  const SunRay sun = sun_ray(field, {options.azimuth_deg * kDegree, options.altitude_deg * kDegree});
  std::vector<Json> rows;
  const auto add = [&](Json row, double share, std::int64_t wrong) {
    row["positive"] = share;
    row["judged"] = options.judged;
    row["wrong"] = wrong;
    rows.push_back(std::move(row));
  };
  const auto share = [&](const auto& codes, auto value) {
    return static_cast<double>(std::count(codes.begin(), codes.end(), value)) / static_cast<double>(nodes);
  };
  std::vector<Seen> seen(nodes);
  Json row =
      measure_map(field, "viewshed", threads, options.repeats, [&] { return sweep_viewshed(view, seen.data()); });
  add(std::move(row), share(seen, Seen::visible), wrong_nodes(field, judged, [&](scarp::Node node, std::size_t i) {
        const double target = view.target(*view.ground().lowered(node));
        return sees(view.ground(), view.observer(), view.eye(), node, target) == (seen[i] == Seen::visible);
      }));
  std::vector<Shade> shades(nodes);
  row =
      measure_map(field, "shadow", threads, options.repeats, [&] { return sweep_shadow(ground, sun, shades.data()); });
  add(std::move(row), share(shades, Shade::lit), wrong_nodes(field, judged, [&](scarp::Node node, std::size_t i) {
        return shade(ground, sun, node) == shades[i];
      }));
  std::vector<double> least(nodes);
  row = measure_map(field, "least height", threads, options.repeats,
                    [&] { return sweep_least_visible(view, least.data()); });
  add(std::move(row), share(seen, Seen::visible), wrong_nodes(field, judged, [&](scarp::Node node, std::size_t i) {
        return least_visible(view.ground(), view.observer(), view.eye(), node) == least[i];
      }));
  return rows;
}

#ifdef SCARP_BENCH_GDAL
// Prints and returns a row for each program and size, the smallest first: what is too slow is not run at larger ones.
std::vector<Json> measure_programs(const MapsOptions& options) {
  std::vector<std::vector<std::string>> lines{
      {"nodes", "map", "program", "s", "CPU s", "MB", "x scarp", "judged", "wrong"}};
  MapPrograms programs(options);
  std::vector<int> sizes = options.sizes;
  std::sort(sizes.begin(), sizes.end());
  std::vector<Json> rows;
  const auto add = [&](std::vector<Json> measured) {
    for (Json& row : measured) {
      lines.push_back({fmt::format("{0} x {0}", row["size"].get<int>()), row["map"], row["program"],
                       short_number(row["seconds"]), short_number(row["cpu_s"]), short_number(row["peak_mb"]),
                       short_number(row["scarp_ratio"]), row["judged"].is_null() ? "-" : row["judged"].dump(),
                       row["wrong"].is_null() ? "-" : row["wrong"].dump()});
      rows.push_back(std::move(row));
    }
  };
  for (const int size : sizes) add(programs.measure(size));
  constexpr int kCumulativeSide = 2048;
  add(programs.measure_cumulative(std::min(sizes.back(), kCumulativeSide)));
  if (!rows.empty()) print_table(lines, 3);
  return rows;
}
#endif

}  // namespace

void run_maps(const MapsOptions& options, const ReportOptions& report) {
  const int all = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<int> threads{1};
  if (all > 1) threads.push_back(all);
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"nodes", "map", "threads", "s", "ns/node", "CPU ns/node", "skipped",
                                               "careful", "by rays", "seen or lit", "wrong"}};
  std::int64_t wrong = 0;
  for (const int size : options.sizes) {
    const ProceduralDem dem{.cols = size, .rows = size, .seed = options.seed, .kind = *terrain_kind(options.kind)};
    const HeightField field =
        HeightField::own(generate_dem(dem), size, size, {.cell_x = dem.cell_m, .cell_y = dem.cell_m});
    for (const int count : threads) {
      for (const Json& row : measure_maps(options, field, count)) {
        const auto percent = [&](const char* name) { return fmt::format("{:.3g} %", 100 * row[name].get<double>()); };
        lines.push_back({fmt::format("{0} x {0}", size), row["map"], short_number(row["threads"]),
                         short_number(row["seconds"]), short_number(row["ns_per_node"]),
                         short_number(row["cpu_ns_per_node"]), percent("skipped"), percent("careful"),
                         percent("walked"), percent("positive"), short_number(row["wrong"])});
        wrong += row["wrong"].get<std::int64_t>();
        rows.push_back(row);
      }
    }
  }
  print_table(lines, 2);
#ifdef SCARP_BENCH_GDAL
  for (Json& row : measure_programs(options)) rows.push_back(std::move(row));
#endif
  write_json(report, rows);
  if (wrong > 0) throw Error(fmt::format("maps: {} nodes differ from their rays", wrong));
}

}  // namespace scarp::bench
