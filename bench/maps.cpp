// SPDX-License-Identifier: MIT
// `scarp-bench maps`: viewsheds and shadows of all nodes: ns per node and the fraction that sweeps skip, checked
// against single rays at random nodes. Also compares `scarp` with other programs that compute such maps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/map_truth.h"
#include "bench/maps_options.h"
#include "bench/random.h"
#include "bench/trace_options.h"
#ifdef SCARP_BENCH_GDAL
#include "bench/map_programs.h"
#include "bench/map_reach.h"
#include "bench/map_task.h"
#include "bench/protocol.h"
#include "bench/report.h"
#endif
#include "scarp/analysis/shadow_sweep.h"
#include "scarp/analysis/sight_rays.h"
#include "scarp/analysis/viewshed_sweep.h"
#include "scarp/analysis/visible_lines.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/source/raster/procedural_dem.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180;

// Lines of sight: their length, and the side of the largest field.
constexpr int kLineCells = 500, kLinesSide = 2048;

HeightField bench_ground(const MapsOptions& options, int size) {
  const ProceduralDem dem{.cols = size, .rows = size, .seed = options.seed, .kind = *terrain_kind(options.kind)};
  return HeightField::own(generate_dem(dem), size, size, {.cell_x = dem.cell_m, .cell_y = dem.cell_m});
}

// `sweep` computes the map again and returns its statistics.
template <class Sweep>
Json measure_map(const HeightField& field, const char* map, int threads, int repeats, const Sweep& sweep) {
  const ThreadLimit limit(threads);
  std::vector<double> seconds, cpu_seconds;
  SweepStatistics counts;
  for (int repeat = 0; repeat <= repeats; ++repeat) {
    const Stopwatch watch;
    counts = sweep();
    // The first pass is the warm-up.
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

// Lines between random points, in random directions, with both ends at the same height above ground.
std::vector<LineEnds> random_lines(const HeightField& field, int count, double height) {
  std::vector<LineEnds> lines;
  for (std::uint64_t n = 0; lines.size() < static_cast<std::size_t>(count); ++n) {
    Random random(2, n);
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const SightEnd from{random.uniform(0, field.cols() - 1), random.uniform(0, field.rows() - 1), height};
    const SightEnd to{from.col + kLineCells * std::cos(angle), from.row + kLineCells * std::sin(angle), height};
    if (to.col >= 0 && to.row >= 0 && to.col <= field.cols() - 1 && to.row <= field.rows() - 1)
      lines.push_back({from, to});
  }
  return lines;
}

// Lines of sight near the ground and far above it, on all threads; each row has the visible fraction.
std::vector<Json> measure_lines(const MapsOptions& options, const HeightField& field, int threads) {
  const ThreadLimit limit(threads);
  std::vector<Json> rows;
  for (const double height : {2.0, 100.0}) {
    const auto lines = random_lines(field, options.lines, height);
    std::vector<double> seconds;
    std::vector<char> visible;
    for (int repeat = 0; repeat < options.repeats; ++repeat) {
      const Stopwatch watch;
      visible = visible_lines(field, lines, BlockMaxima(field));
      seconds.push_back(watch.wall_s());
    }
    std::int64_t wrong = 0;
    const std::size_t judged = std::min(lines.size(), static_cast<std::size_t>(options.judged));
    for (std::size_t i = 0; i < judged; ++i)
      wrong += line_of_sight(field, lines[i].from, lines[i].to).visible != (visible[i] != 0);
    const auto seen = std::count(visible.begin(), visible.end(), 1);
    rows.push_back({{"size", field.cols()},
                    {"map", "lines of sight"},
                    {"threads", threads},
                    {"lines", lines.size()},
                    {"height", height},
                    {"seconds", median(seconds)},
                    {"ns_per_line", median(seconds) / static_cast<double>(lines.size()) * 1e9},
                    {"positive", static_cast<double>(seen) / static_cast<double>(lines.size())},
                    {"judged", judged},
                    {"wrong", wrong}});
  }
  return rows;
}

#ifdef SCARP_BENCH_GDAL
// Prints and returns a row for each program and size, the smallest first: programs that are too slow do not run at
// larger ones.
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
  std::vector<std::vector<std::string>> reach{{"program", "s", "CPU s", "MB", "x gdal_viewshed", "CPU"}};
  for (Json& row : measure_reach(options)) {
    reach.push_back({row["program"], short_number(row["seconds"]), short_number(row["cpu_s"]),
                     short_number(row["peak_mb"]), short_number(row["gdal_ratio"]),
                     short_number(row["gdal_cpu_ratio"])});
    rows.push_back(std::move(row));
  }
  if (reach.size() > 1) print_table(reach, 1);
  return rows;
}
#endif

// Throws Error, after the report, if a node differs from its ray.
void run_maps(const MapsOptions& options, const ReportOptions& report) {
  const int all = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<int> threads{1};
  if (all > 1) threads.push_back(all);
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"nodes", "map", "threads", "s", "ns/node", "CPU ns/node", "skipped",
                                               "careful", "by rays", "seen or lit", "wrong"}};
  std::int64_t wrong = 0;
  for (const int size : options.sizes) {
    const HeightField field = bench_ground(options, size);
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
  const int lines_side = std::min(kLinesSide, *std::max_element(options.sizes.begin(), options.sizes.end()));
  if (options.lines > 0 && lines_side > kLineCells) {
    std::vector<std::vector<std::string>> table{
        {"nodes", "threads", "lines", "m above ground", "s", "ns/line", "visible", "wrong"}};
    const HeightField field = bench_ground(options, lines_side);
    for (const int count : threads) {
      for (const Json& row : measure_lines(options, field, count)) {
        table.push_back({fmt::format("{0} x {0}", lines_side), short_number(count), short_number(row["lines"], 8),
                         short_number(row["height"]), short_number(row["seconds"]), short_number(row["ns_per_line"]),
                         fmt::format("{:.3g} %", 100 * row["positive"].get<double>()), short_number(row["wrong"])});
        wrong += row["wrong"].get<std::int64_t>();
        rows.push_back(row);
      }
    }
    print_table(table, 1);
  }
#ifdef SCARP_BENCH_GDAL
  for (Json& row : measure_programs(options)) rows.push_back(std::move(row));
#endif
  write_json(report, rows);
  if (wrong > 0) throw Error(fmt::format("maps: {} nodes differ from their rays", wrong));
}

}  // namespace

void add_maps(cli::Program& program) {
  auto [command, o] = add_command<MapsOptions>(program, "maps", "Viewsheds and shadows of all nodes", run_maps);
  command.add(cli::List<int>{&o.sizes}, {.names = "--sizes", .help = "samples per side", .range = {2, 32768}});
  command.add(
      &o.kind,
      {.names = "--kind", .value = "KIND", .help = "procedural DEM", .choices = {"fbm", "ridged"}, .closed = true});
  command.add(&o.seed, {.names = "--seed", .help = "seed of the DEM"});
  command.add(&o.observer_height, {.names = "--observer-height",
                                   .help = "height of the observer above ground",
                                   .unit = "metres",
                                   .range = {0, 1e6}});
  command.add(&o.azimuth_deg,
              {.names = "--sun-azimuth", .help = "azimuth of the sun", .unit = "degrees", .range = {0, 360}});
  command.add(&o.altitude_deg,
              {.names = "--sun-altitude", .help = "altitude of the sun", .unit = "degrees", .range = {1, 90}});
  add_repeats_option(command, o.repeats);
  command.add(&o.judged,
              {.names = "--judged", .help = "nodes per map that are also decided by a ray", .range = {0, 1e6}});
  command.add(&o.lines,
              {.names = "--lines", .help = "lines of sight, of 500 cells each", .range = {0, 1e8}, .note = "0: none"});
#ifdef SCARP_BENCH_GDAL
  std::vector<std::string> known = o.programs;
  known.emplace_back("none");
  command.add(cli::List<std::string>{&o.programs}, {.names = "--programs",
                                                    .help = "programs to measure as whole processes, if installed",
                                                    .choices = std::move(known),
                                                    .closed = true});
  add_scarp_option(command, o.scarp);
  command.add(
      &o.observers,
      {.names = "--observers", .help = "observers of a cumulative viewshed", .range = {0, 65533}, .note = "0: none"});
  command.add(&o.reach, {.names = "--reach", .help = "also measure small parts of 40,000 x 40,000 samples"});
  command.add(
      &o.program_limit_s,
      {.names = "--program-limit", .help = "longest run of a program", .unit = "seconds", .range = cli::kAboveZero});
#endif
}

}  // namespace scarp::bench
