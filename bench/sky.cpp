// SPDX-License-Identifier: MIT
// `scarp-bench sky`: horizons of nodes, by scarp/analysis/horizon.h and by rays of Embree over the same ground as
// triangles. Embree's rays look for each horizon as published: C. R. Steger, B. Steger, C. Schaer, "HORAYZON v1.2: an
// efficient and flexible ray-tracing algorithm to compute horizon and sky view factor", Geoscientific Model Development
// 15, 2022: by bisection, or from the horizon of the previous azimuth on. Both to 0.25 degree; the faster counts.
#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/denormals_off.h"
#include "bench/embree_peer.h"
#include "bench/fields.h"
#include "bench/protocol.h"
#include "bench/random.h"
#include "bench/report.h"
#ifdef SCARP_BENCH_GDAL
#include "bench/map_task.h"
#include "bench/sky_programs.h"
#endif
#include "bench/trace_options.h"
#include "scarp/analysis/horizon.h"
#include "scarp/analysis/sky_view.h"
#include "scarp/base/parallel.h"

namespace scarp::bench {
namespace {

struct SkyOptions {
  FieldOptions field;
  std::vector<int> sizes{1024, 4096}, threads{1};
  int azimuths = 16;  // of the engine; beside the directions of the grid
  int nodes = 4000;   // of Embree
  int repeats = 3;
  bool maps = false;
  std::vector<std::string> programs;
  std::string scarp;
};

using Json = nlohmann::ordered_json;

constexpr double kMillion = 1e6;
constexpr double kPi = std::numbers::pi, kAccuracy = 0.25 * kPi / 180, kLowest = -kPi / 2, kHighest = kPi / 2;

// Azimuths are half a step beside north: in the directions of the grid there are half as many crossings.
double azimuth_of(int i, int count) { return 2 * kPi * (i + 0.5) / count; }

// Blocks of neighbours at random places: their rays meet the same parts of Embree's tree one after another, as in a
// map.
std::vector<Node> sampled_nodes(const HeightField& field, int count) {
  constexpr int kSide = 16;
  Random random(1, 0);
  std::vector<Node> nodes;
  while (static_cast<int>(nodes.size()) < count) {
    const auto below = [&](int n) { return static_cast<int>(random.below(static_cast<std::uint64_t>(n - kSide + 1))); };
    const int col = below(field.cols()), row = below(field.rows());
    for (int i = 0; i < kSide * kSide; ++i) nodes.push_back({col + i % kSide, row + i / kSide});
  }
  return nodes;
}

// The horizon of a node in an azimuth by Embree: the largest angle at which a ray is blocked, found to kAccuracy.
class EmbreeHorizon {
 public:
  // `east` and `north`: direction of the azimuth.
  EmbreeHorizon(RTCScene scene, const dvec3& origin, double east, double north)
      : scene_(scene), east_(east), north_(north) {
    constexpr float kLift = 0x1p-10f;  // metres
    ray_.org_x = static_cast<float>(origin.x), ray_.org_y = static_cast<float>(origin.y);
    ray_.org_z = static_cast<float>(origin.z) + kLift;
    ray_.mask = ~0u;
  }

  // By bisection of all angles.
  double bisect() const { return between(kLowest, kHighest); }

  // From a guess in steps that double, then by bisection.
  double from_guess(double guess) const {
    const bool low = blocked(guess);
    double from = guess;
    for (double step = kAccuracy;; step *= 2) {
      const double to = std::clamp(low ? from + step : from - step, kLowest, kHighest);
      if (to == kLowest || to == kHighest || blocked(to) != low) return low ? between(from, to) : between(to, from);
      from = to;
    }
  }

 private:
  double between(double low, double high) const {
    while (high - low > kAccuracy) {
      const double middle = 0.5 * (low + high);
      (blocked(middle) ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  bool blocked(double angle) const {
    RTCRay ray = ray_;
    const double level = std::cos(angle);
    ray.dir_x = static_cast<float>(east_ * level), ray.dir_y = static_cast<float>(north_ * level);
    ray.dir_z = static_cast<float>(std::sin(angle));
    ray.tfar = std::numeric_limits<float>::infinity();
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_, &context, &ray);
    return ray.tfar < 0;
  }

  RTCScene scene_;
  const double east_, north_;
  RTCRay ray_{};
};

// Horizons of the nodes in all azimuths, node by node.
std::vector<double> by_embree(const HeightField& field, const EmbreePeer& peer, const std::vector<Node>& nodes,
                              int azimuths, bool guess) {
  std::vector<dvec2> directions;
  for (int a = 0; a < azimuths; ++a) {
    const double azimuth = azimuth_of(a, azimuths);
    directions.emplace_back(std::sin(azimuth), std::cos(azimuth));
  }
  std::vector<double> angles(nodes.size() * static_cast<std::size_t>(azimuths));
  parallel_for(static_cast<std::int64_t>(nodes.size()), 16, [&](std::int64_t begin, std::int64_t end) {
    const DenormalsOff denormals_off;
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      double* angle = &angles[i * directions.size()];
      const double height =
          field.visit([&](const auto& grid) { return static_cast<double>(grid.at(nodes[i].col, nodes[i].row)); });
      const dvec3 origin = field.world_from_grid(nodes[i].col, nodes[i].row, height);
      for (std::size_t a = 0; a < directions.size(); ++a) {
        const EmbreeHorizon embree(peer.scene(), origin, directions[a].x, directions[a].y);
        angle[a] = guess && a > 0 ? embree.from_guess(angle[a - 1]) : embree.bisect();
      }
    }
  });
  return angles;
}

struct SkyRow {
  std::string engine;
  double rate, cpu_rate;                 // million azimuths of nodes per second of wall-clock and of processor time
  double build_s, error_p50, error_p99;  // degrees
};

// The rows [first, last) of nodes that are timed: all of small fields, bands of large ones.
std::vector<std::pair<int, int>> bands_of(const HeightField& field) {
  constexpr int kWhole = 2048, kBand = 64, kEvery = 512;
  if (field.rows() <= kWhole) return {{0, field.rows()}};
  std::vector<std::pair<int, int>> bands;
  for (int row = 0; row + kBand <= field.rows(); row += kEvery) bands.emplace_back(row, row + kBand);
  return bands;
}

// The value that this share of all is not above.
double quantile(std::vector<double>& values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

struct Seconds {
  double wall, cpu;
};

// Medians of the timed passes.
Seconds seconds_of(int repeats, const std::function<void()>& work) {
  std::vector<double> wall, cpu;
  for (int pass = 0; pass < repeats; ++pass) {
    const Stopwatch watch;
    work();
    wall.push_back(watch.wall_s()), cpu.push_back(watch.cpu_s());
  }
  return {median(wall), median(cpu)};
}

std::vector<SkyRow> measure_sky(const HeightField& field, const SkyOptions& options, int threads) {
  const ThreadLimit limit(threads);
  const auto bands = bands_of(field);
  HorizonSettings settings;
  settings.curvature.coefficient = 0;  // as Embree's triangles
  std::vector<SkyRow> rows;
  const auto add = [&](const char* engine, double horizons, const Seconds& seconds, double build_s,
                       std::vector<double> errors) {
    rows.push_back({engine, horizons / seconds.wall / kMillion, horizons / seconds.cpu / kMillion, build_s,
                    quantile(errors, 0.5), quantile(errors, 0.99)});
  };

  const Stopwatch building;
  const Horizons exact(field, settings);
  const double build_s = building.wall_s();
  double counted = 0;
  for (const auto& [first, last] : bands) counted += static_cast<double>(field.cols()) * (last - first);
  add("exact", counted * options.azimuths,
      seconds_of(options.repeats,
                 [&] {
                   for (int a = 0; a < options.azimuths; ++a) {
                     for (const auto& [first, last] : bands) exact.rows(azimuth_of(a, options.azimuths), first, last);
                   }
                 }),
      build_s, {0});

  // A sweep passes over the whole field.
  settings.engine = HorizonEngine::sweep;
  const Stopwatch copying;
  const Horizons sweep(field, settings);
  const double copy_s = copying.wall_s();
  std::vector<double> swept_errors;
  for (int a = 0; a < options.azimuths; ++a) {
    const double azimuth = azimuth_of(a, options.azimuths);
    const HorizonRows found = sweep.rows(azimuth, 0, field.rows());
    for (const auto& [first, last] : bands) {
      const HorizonRows truth = exact.rows(azimuth, first, last);
      const std::size_t from = static_cast<std::size_t>(first) * static_cast<std::size_t>(field.cols());
      for (std::size_t i = 0; i < truth.angle.size(); i += 7)
        swept_errors.push_back(static_cast<double>(std::abs(truth.angle[i] - found.angle[from + i])) * 180 / kPi);
    }
  }
  add("sweep", static_cast<double>(field.cols()) * field.rows() * options.azimuths,
      seconds_of(options.repeats,
                 [&] {
                   for (int a = 0; a < options.azimuths; ++a)
                     sweep.rows(azimuth_of(a, options.azimuths), 0, field.rows());
                 }),
      copy_s, std::move(swept_errors));

  constexpr int kMostOfTriangles = 8193;  // 10 GB
  if (field.cols() > kMostOfTriangles) return rows;
  settings.engine = HorizonEngine::exact;
  const Stopwatch embree_building;
  const EmbreePeer peer(field, EmbreeSurface::triangles, EmbreeQuality::medium);
  const double embree_build_s = embree_building.wall_s();
  const std::vector<Node> nodes = sampled_nodes(field, options.nodes);
  for (const bool guess : {false, true}) {
    std::vector<double> angles;
    const Seconds seconds =
        seconds_of(options.repeats, [&] { angles = by_embree(field, peer, nodes, options.azimuths, guess); });
    std::vector<double> errors;
    for (std::size_t i = 0; i < nodes.size(); i += 16) {
      for (int a = 0; a < options.azimuths; ++a) {
        const auto truth = horizon_from(field, nodes[i].col, nodes[i].row, azimuth_of(a, options.azimuths), settings);
        const double found = angles[i * static_cast<std::size_t>(options.azimuths) + static_cast<std::size_t>(a)];
        // At the border there is no ground to be seen.
        if (truth && truth->distance) errors.push_back(std::abs(truth->angle - found) * 180 / kPi);
      }
    }
    add(guess ? "embree, guess" : "embree, bisection", static_cast<double>(angles.size()), seconds, embree_build_s,
        std::move(errors));
  }
  return rows;
}

// Seconds of a whole map of the sky fraction, of 64 azimuths.
void measure_sky_fraction(const HeightField& field, int threads, std::vector<std::vector<std::string>>& lines,
                          Json& rows) {
  const ThreadLimit limit(threads);
  HorizonSettings settings;
  std::vector<std::vector<float>> maps[2];
  for (const HorizonEngine engine : {HorizonEngine::exact, HorizonEngine::sweep}) {
    settings.engine = engine;
    const bool swept = engine == HorizonEngine::sweep;
    const Stopwatch watch;
    maps[swept] = SkyView(field, settings, 64, {SkyMeasure::sky_fraction}).rows(0, field.rows());
    const double seconds = watch.wall_s(), cpu = watch.cpu_s();
    double sum = 0;
    for (std::size_t i = 0; swept && i < maps[0][0].size(); ++i)
      sum += static_cast<double>(std::abs(maps[1][0][i] - maps[0][0][i]));
    const double error = sum / static_cast<double>(maps[0][0].size());
    const char* name = swept ? "sweep" : "exact";
    lines.push_back({fmt::format("{0} x {0}", field.cols()), fmt::format("{}", threads), name, short_number(seconds),
                     short_number(cpu), short_number(error)});
    rows.push_back({{"size", field.cols()},
                    {"threads", threads},
                    {"engine", name},
                    {"sky_fraction_s", seconds},
                    {"cpu_s", cpu},
                    {"mean_error", error}});
  }
}

#ifdef SCARP_BENCH_GDAL
void run_programs(const SkyOptions& options, const ReportOptions& report) {
  std::vector<std::vector<std::string>> lines{
      {"samples", "map", "program", "s", "CPU s", "MB", "x scarp exact", "error mean", "p99"}};
  Json rows = Json::array();
  for (const int size : options.sizes) {
    SkyProgramOptions asked;
    asked.scarp = options.scarp, asked.size = size, asked.repeats = options.repeats, asked.programs = options.programs;
    for (Json& row : measure_sky_programs(asked)) {
      std::vector<std::string> line{fmt::format("{0} x {0}", size), row["map"], row["program"]};
      for (const char* name : {"seconds", "cpu_s", "peak_mb", "scarp_ratio", "error_mean", "error_p99"})
        line.push_back(short_number(row[name]));
      lines.push_back(std::move(line));
      rows.push_back(std::move(row));
    }
  }
  print_table(lines, 3);
  write_json(report, rows);
}
#endif

void run_sky(const SkyOptions& options, const ReportOptions& report) {
#ifdef SCARP_BENCH_GDAL
  if (!options.programs.empty()) return run_programs(options, report);
#endif
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{
      {"samples", "threads", "engine", "sky fraction s", "CPU s", "mean error"}};
  if (!options.maps)
    lines = {{"samples", "threads", "engine", "M node-azimuths/s", "per CPU s", "x faster Embree", "build s",
              "error p50", "p99 degrees"}};
  for (const int size : options.sizes) {
    FieldOptions asked = options.field;
    asked.size = size;
    const BenchField ground = load_field(asked);
    for (const int threads : options.threads) {
      if (options.maps) {
        measure_sky_fraction(ground.field, threads, lines, rows);
        continue;
      }
      const std::vector<SkyRow> found = measure_sky(ground.field, options, threads);
      const double peer = found.size() > 2 ? std::max(found[2].rate, found[3].rate) : 0;
      for (const SkyRow& one : found) {
        Json row;
        row["size"] = ground.field.cols(), row["field"] = ground.name, row["threads"] = threads;
        row["engine"] = one.engine, row["mnodes_azimuths_per_s"] = one.rate,
        row["of_faster_embree"] = peer > 0 ? Json(one.rate / peer) : Json();
        row["mnodes_azimuths_per_cpu_s"] = one.cpu_rate;
        row["build_s"] = one.build_s, row["error_p50_deg"] = one.error_p50, row["error_p99_deg"] = one.error_p99;
        lines.push_back({fmt::format("{0} x {0}", ground.field.cols()), fmt::format("{}", threads), one.engine,
                         short_number(row["mnodes_azimuths_per_s"]), short_number(row["mnodes_azimuths_per_cpu_s"]),
                         short_number(row["of_faster_embree"]), short_number(row["build_s"]),
                         short_number(row["error_p50_deg"]), short_number(row["error_p99_deg"])});
        rows.push_back(std::move(row));
      }
    }
  }
  print_table(lines, 3);
  write_json(report, rows);
}

}  // namespace

void add_sky(cli::Program& program) {
  auto [command, o] =
      add_command<SkyOptions>(program, "sky", "Horizons of nodes, compared with rays of Embree", run_sky);
  add_sizes_option(command, o.sizes);
  command.add(cli::List<int>{&o.threads}, {.names = "--threads", .help = "numbers of threads", .range = {1, 1024}});
  command.add(&o.azimuths, {.names = "--azimuths", .help = "directions", .range = {1, 3600}});
  command.add(&o.nodes, {.names = "--nodes", .help = "nodes that Embree answers", .range = {16, 1e8}});
  add_repeats_option(command, o.repeats, "timed passes of each");
  command.add(&o.maps,
              {.names = "--maps", .help = "instead: whole maps of the sky fraction, 64 azimuths, by each engine"});
#ifdef SCARP_BENCH_GDAL
  command.add(cli::List<std::string>{&o.programs},
              {.names = "--programs",
               .help = "instead: programs to measure as whole processes, if installed",
               .choices = {"scarp", "r.horizon", "r.sun", "saga"},
               .closed = true,
               .fallback = "none"});
  add_scarp_option(command, o.scarp);
#endif
}

}  // namespace scarp::bench
