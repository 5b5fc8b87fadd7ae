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
#include "bench/trace_options.h"
#include "scarp/analysis/horizon.h"
#include "scarp/base/parallel.h"

namespace scarp::bench {
namespace {

struct SkyOptions {
  FieldOptions field;
  std::vector<int> sizes{1024, 4096}, threads{1};
  int azimuths = 16;  // of the engine; beside the directions of the grid
  int nodes = 4000;   // of Embree
  int repeats = 3;
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

// The horizon of a node by Embree: the largest angle at which a ray is blocked, found to kAccuracy.
class EmbreeHorizons {
 public:
  EmbreeHorizons(const HeightField& field, const EmbreePeer& peer) : field_(field), scene_(peer.scene()) {}

  // By bisection of all angles.
  double bisect(const Node& node, double azimuth) const { return between(node, azimuth, kLowest, kHighest); }

  // From a guess in steps that double, then by bisection.
  double from_guess(const Node& node, double azimuth, double guess) const {
    const bool low = blocked(node, azimuth, guess);
    double from = guess;
    for (double step = kAccuracy;; step *= 2) {
      const double to = std::clamp(low ? from + step : from - step, kLowest, kHighest);
      if (to == kLowest || to == kHighest || blocked(node, azimuth, to) != low)
        return low ? between(node, azimuth, from, to) : between(node, azimuth, to, from);
      from = to;
    }
  }

 private:
  double between(const Node& node, double azimuth, double low, double high) const {
    while (high - low > kAccuracy) {
      const double middle = 0.5 * (low + high);
      (blocked(node, azimuth, middle) ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  bool blocked(const Node& node, double azimuth, double angle) const {
    constexpr double kLift = 0x1p-10;  // cells
    const dvec3 from = field_.world_from_grid(node.col, node.row, sample(node));
    RTCRay ray{};
    ray.org_x = static_cast<float>(from.x), ray.org_y = static_cast<float>(from.y);
    ray.org_z = static_cast<float>(from.z + kLift);
    ray.dir_x = static_cast<float>(std::sin(azimuth) * std::cos(angle));
    ray.dir_y = static_cast<float>(std::cos(azimuth) * std::cos(angle));
    ray.dir_z = static_cast<float>(std::sin(angle));
    ray.tfar = std::numeric_limits<float>::infinity(), ray.mask = ~0u;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_, &context, &ray);
    return ray.tfar < 0;
  }
  double sample(const Node& node) const {
    return field_.visit([&](const auto& grid) { return static_cast<double>(grid.at(node.col, node.row)); });
  }

  const HeightField& field_;
  RTCScene scene_;
};

// Horizons of the nodes in all azimuths, node by node.
std::vector<double> by_embree(const EmbreeHorizons& embree, const std::vector<Node>& nodes, int azimuths, bool guess) {
  std::vector<double> angles(nodes.size() * static_cast<std::size_t>(azimuths));
  parallel_for(static_cast<std::int64_t>(nodes.size()), 16, [&](std::int64_t begin, std::int64_t end) {
    const DenormalsOff denormals_off;
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      double* angle = &angles[i * static_cast<std::size_t>(azimuths)];
      for (int a = 0; a < azimuths; ++a) {
        const double azimuth = azimuth_of(a, azimuths);
        angle[a] =
            guess && a > 0 ? embree.from_guess(nodes[i], azimuth, angle[a - 1]) : embree.bisect(nodes[i], azimuth);
      }
    }
  });
  return angles;
}

struct SkyRow {
  std::string engine;
  double rate, build_s, error_p50, error_p99;  // million azimuths of nodes per second; degrees
};

// The rows [first, last) of nodes that are timed: all of small fields, bands of large ones.
std::vector<std::pair<int, int>> bands_of(const HeightField& field) {
  constexpr int kWhole = 2048, kBand = 64, kEvery = 512;
  if (field.rows() <= kWhole) return {{0, field.rows()}};
  std::vector<std::pair<int, int>> bands;
  for (int row = 0; row + kBand <= field.rows(); row += kEvery) bands.emplace_back(row, row + kBand);
  return bands;
}

std::vector<SkyRow> measure_sky(const HeightField& field, const SkyOptions& options, int threads) {
  const ThreadLimit limit(threads);
  const auto bands = bands_of(field);
  HorizonSettings settings;
  settings.curvature.coefficient = 0;  // as Embree's triangles
  const Stopwatch building;
  const Horizons horizons(field, settings);
  const double build_s = building.wall_s();
  std::vector<double> seconds;
  double counted = 0;
  for (const auto& [first, last] : bands) counted += static_cast<double>(field.cols()) * (last - first);
  for (int pass = 0; pass < options.repeats; ++pass) {
    const Stopwatch watch;
    for (int a = 0; a < options.azimuths; ++a) {
      for (const auto& [first, last] : bands) horizons.rows(azimuth_of(a, options.azimuths), first, last);
    }
    seconds.push_back(watch.wall_s());
  }
  std::vector<SkyRow> rows{{"exact", counted * options.azimuths / median(seconds) / kMillion, build_s, 0, 0}};

  const Stopwatch embree_building;
  const EmbreePeer peer(field, EmbreeSurface::triangles, EmbreeQuality::medium);
  const double embree_build_s = embree_building.wall_s();
  const EmbreeHorizons embree(field, peer);
  const std::vector<Node> nodes = sampled_nodes(field, options.nodes);
  for (const bool guess : {false, true}) {
    std::vector<double> angles;
    seconds.clear();
    for (int pass = 0; pass < options.repeats; ++pass) {
      const Stopwatch watch;
      angles = by_embree(embree, nodes, options.azimuths, guess);
      seconds.push_back(watch.wall_s());
    }
    std::vector<double> errors;
    for (std::size_t i = 0; i < nodes.size(); i += 16) {
      for (int a = 0; a < options.azimuths; ++a) {
        const auto truth = horizon_from(field, nodes[i].col, nodes[i].row, azimuth_of(a, options.azimuths), settings);
        // At the border there is no ground to be seen.
        if (truth && truth->distance)
          errors.push_back(
              std::abs(truth->angle -
                       angles[i * static_cast<std::size_t>(options.azimuths) + static_cast<std::size_t>(a)]) *
              180 / kPi);
      }
    }
    std::sort(errors.begin(), errors.end());
    const auto at = [&](double share) {
      return errors[static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1))];
    };
    const double rate = static_cast<double>(angles.size()) / median(seconds) / kMillion;
    rows.push_back({guess ? "embree, guess" : "embree, bisection", rate, embree_build_s, at(0.5), at(0.99)});
  }
  return rows;
}

void run_sky(const SkyOptions& options, const ReportOptions& report) {
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{
      {"samples", "threads", "engine", "M node-azimuths/s", "x faster Embree", "build s", "error p50", "p99 degrees"}};
  for (const int size : options.sizes) {
    FieldOptions asked = options.field;
    asked.size = size;
    const BenchField ground = load_field(asked);
    for (const int threads : options.threads) {
      const std::vector<SkyRow> found = measure_sky(ground.field, options, threads);
      const double peer = std::max(found[1].rate, found[2].rate);
      for (const SkyRow& one : found) {
        Json row;
        row["size"] = ground.field.cols(), row["field"] = ground.name, row["threads"] = threads;
        row["engine"] = one.engine, row["mnodes_azimuths_per_s"] = one.rate, row["of_faster_embree"] = one.rate / peer;
        row["build_s"] = one.build_s, row["error_p50_deg"] = one.error_p50, row["error_p99_deg"] = one.error_p99;
        lines.push_back({fmt::format("{0} x {0}", ground.field.cols()), fmt::format("{}", threads), one.engine,
                         short_number(row["mnodes_azimuths_per_s"]), short_number(row["of_faster_embree"]),
                         short_number(row["build_s"]), short_number(row["error_p50_deg"]),
                         short_number(row["error_p99_deg"])});
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
}

}  // namespace scarp::bench
