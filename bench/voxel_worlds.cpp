// SPDX-License-Identifier: MIT
// `scarp-bench voxel-worlds`: procedural ground as voxels, thousands per side: build time, memory, and the rays of
// pictures, one at a time and in batches; compared with NanoVDB over the visible voxels.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/fields.h"
#include "bench/trace_options.h"
#ifdef SCARP_BENCH_NANOVDB
#include "bench/nanovdb_peer.h"
#endif
#include "bench/protocol.h"
#include "bench/report.h"
#include "bench/voxel_engine.h"
#include "scarp/base/parallel.h"
#include "scarp/field/ground_voxels.h"
#include "scarp/scene/scene.h"

namespace scarp::bench {
namespace {

// `voxel-worlds`: procedural ground as voxels, thousands per side.
struct VoxelWorldsOptions {
  int side = 4096;  // voxels
  int width = 256;  // pixels per side of the pictures, from four corners, a multiple of 8
  int repeats = 3;
  bool planes = false;            // also voxel-planes, which visits every voxel
  std::optional<bool> nanovdb{};  // also NanoVDB, where installed
};

using Json = nlohmann::ordered_json;

constexpr double kMiB = 1 << 20, kMillion = 1e6;
constexpr int kTile = 8;

// Tops of columns, one per sample, shifted so that the lowest is 1.
std::vector<std::int32_t> tops_of(const HeightField& field, int side) {
  std::vector<std::int32_t> tops(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  const double lowest = field.min_height();
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double height = field.height(x, y).value_or(lowest) - lowest;
      tops[static_cast<std::size_t>(x) + static_cast<std::size_t>(side) * static_cast<std::size_t>(y)] =
          std::clamp(static_cast<std::int32_t>(height) + 1, 1, side);
    }
  }
  return tops;
}

// From above each corner of the world towards its middle, in tiles of 8 x 8 pixels.
std::vector<Ray> world_rays(int side, double highest, int width) {
  std::vector<Ray> rays;
  for (int corner = 0; corner < 4; ++corner) {
    const dvec3 eye(corner & 1 ? 0.97 * side : 0.03 * side, corner & 2 ? 0.96 * side : 0.04 * side, 1.4 * highest);
    const dvec3 forward = normalize(dvec3(0.5 * side, 0.52 * side, 0.3 * highest) - eye);
    const dvec3 right = normalize(cross(forward, dvec3(0, 0, 1))), up = cross(right, forward);
    for (int top = 0; top < width; top += kTile) {
      for (int left = 0; left < width; left += kTile) {
        for (int pixel = 0; pixel < kTile * kTile; ++pixel) {
          const double x = 2 * (left + pixel % kTile + 0.5) / width - 1,
                       y = 1 - 2 * (top + pixel / kTile + 0.5) / width;
          Ray ray;
          ray.origin = dvec3(glm::vec3(eye));
          ray.direction = dvec3(glm::vec3(normalize(forward + 0.5 * x * right + 0.35 * y * up)));
          rays.push_back(ray);
        }
      }
    }
  }
  return rays;
}

double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

#ifdef SCARP_BENCH_NANOVDB
// Sets the voxels of columns that rays can hit: from each top down to the lowest adjacent top.
void set_visible_voxels(int side, const std::vector<std::int32_t>& tops, const NanovdbPeer::Set& set) {
  const auto top = [&](int x, int y) {
    return x < 0 || y < 0 || x >= side || y >= side
               ? 0
               : tops[static_cast<std::size_t>(x) + static_cast<std::size_t>(side) * static_cast<std::size_t>(y)];
  };
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const int end = top(x, y);
      for (int z = std::min({end - 1, top(x - 1, y), top(x + 1, y), top(x, y - 1), top(x, y + 1)}); z < end; ++z)
        set({x, y, z}, static_cast<float>(1 + z % 255));
    }
  }
}
#endif

void run_voxel_worlds(const VoxelWorldsOptions& options, const ReportOptions& report) {
  FieldOptions ground_options;
  ground_options.size = std::max(options.side, 33);
  const BenchField ground = load_field(ground_options);
  const std::vector<std::int32_t> tops = tops_of(ground.field, options.side);
  const double highest = *std::max_element(tops.begin(), tops.end());

  const Stopwatch build;
  VoxelGrid grid = ground_voxels(ivec3(options.side), tops, 8, [](const ivec3& v) { return 1 + v.z % 255; });
  const std::int64_t solid = grid.solid_count();
  const double grid_mib = static_cast<double>(grid.bytes()) / kMiB;
  auto model = std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-bricks"));
  const double build_s = build.wall_s(), build_peak = peak_mib();

  const std::vector<Ray> rays = world_rays(options.side, highest, options.width);
  std::vector<std::unique_ptr<Scene>> scenes;
  std::vector<VoxelEngine> engines;
  const auto add = [&](const std::shared_ptr<const VoxelModel>& of) {
    scenes.push_back(std::make_unique<Scene>(scene_voxels({{of}, {VoxelPlace{}}})));
    const Scene& scene = *scenes.back();
    const double mib = static_cast<double>(of->bytes()) / kMiB;
    engines.push_back({std::string(of->march().name), "x1", "bounds", mib, [&scene](auto from, auto hits) {
                         for (std::size_t i = 0; i < from.size(); ++i) hits[i] = scene.closest_hit(from[i]);
                       }});
    engines.push_back({std::string(of->march().name), "x64", "bounds", mib,
                       [&scene](auto from, auto hits) { scene.closest_hits(from, hits); }});
  };
  add(model);
  if (options.planes) add(std::make_shared<const VoxelModel>(model->marched_by(find_voxel_march("voxel-planes"))));
#ifdef SCARP_BENCH_NANOVDB
  std::unique_ptr<NanovdbPeer> nanovdb;
  if (options.nanovdb.value_or(true)) {
    nanovdb = std::make_unique<NanovdbPeer>(
        [&](const NanovdbPeer::Set& set) { set_visible_voxels(options.side, tops, set); });
    for (VoxelEngine& engine : nanovdb->engines()) engines.push_back(std::move(engine));
  }
#endif

  const ThreadLimit limit(1);
  std::vector<Hit> expected(rays.size()), answers(rays.size());
  scenes[0]->closest_hits(rays, expected);
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{
      {"side", "engine", "mode", "Mrays/s", "hits", "other ppm", "steps", "MiB", "build s", "peak MiB"}};
  std::vector<std::vector<double>> seconds(engines.size());
  std::vector<std::size_t> others(engines.size()), hits(engines.size());
  // Steps are the same one at a time and in batches.
  std::vector<std::optional<double>> steps(engines.size());
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    std::vector<std::uint32_t> of_rays(rays.size());
    scenes[s]->closest_hits(rays, answers, of_rays);
    const double all = std::accumulate(of_rays.begin(), of_rays.end(), 0.0);
    steps[2 * s] = steps[2 * s + 1] = all / static_cast<double>(rays.size());
  }
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    for (std::size_t e = 0; e < engines.size(); ++e) {
      const Stopwatch watch;
      engines[e].trace(rays, answers);
      seconds[e].push_back(watch.cpu_s());
      if (repeat > 0) continue;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        hits[e] += answers[i] ? 1 : 0;
        const bool same = static_cast<bool>(answers[i]) == static_cast<bool>(expected[i]) &&
                          (!expected[i] || answers[i].voxel == expected[i].voxel);
        others[e] += same ? 0 : 1;
      }
    }
  }
  for (std::size_t e = 0; e < engines.size(); ++e) {
    const double count = static_cast<double>(rays.size());
    Json row = {{"side", options.side},
                {"solid", solid},
                {"engine", engines[e].name},
                {"mode", engines[e].mode},
                {"mrays_per_cpu_s", count / kMillion / median(seconds[e])},
                {"hit_share", static_cast<double>(hits[e]) / count},
                {"other_ppm", 1e6 * static_cast<double>(others[e]) / count},
                {"steps_per_ray", steps[e] ? Json(*steps[e]) : Json()},
                {"mib", engines[e].mib},
                {"grid_mib", grid_mib},
                {"build_s", build_s},
                {"build_peak_mib", build_peak}};
    std::vector<std::string> line{std::to_string(options.side), engines[e].name, engines[e].mode};
    for (const char* key :
         {"mrays_per_cpu_s", "hit_share", "other_ppm", "steps_per_ray", "mib", "build_s", "build_peak_mib"})
      line.push_back(short_number(row[key]));
    lines.push_back(std::move(line));
    rows.push_back(std::move(row));
  }
  print_table(lines, 3);
  write_json(report, rows);
}

}  // namespace

void add_voxel_worlds(cli::Program& program) {
  auto [command, o] =
      add_command<VoxelWorldsOptions>(program, "voxel-worlds", "Ground of voxels, thousands a side", run_voxel_worlds);
  command.add(&o.side, {.names = "--side", .help = "voxels per side", .range = {33, 16384}});
  command.add(&o.width,
              {.names = "--width", .help = "pixels per side of the pictures, a multiple of 8", .range = {8, 2048}});
  add_repeats_option(command, o.repeats);
  command.add(&o.planes, {.names = "--planes", .help = "also voxel-planes, which visits every voxel"});
  command.add(cli::Off{&o.nanovdb}, {.names = "--no-nanovdb", .help = "without NanoVDB"});
}

}  // namespace scarp::bench
