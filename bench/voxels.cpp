// SPDX-License-Identifier: MIT
// `scarp-bench voxels`: the tables of the founding post for the marches of voxel grids: time per frame, memory, steps
// and boxes per ray, and the time that builders take.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "bench/commands.h"
#include "bench/protocol.h"
#include "bench/voxel_sets.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPixels = 1920.0 * 1080.0;
constexpr double kMiB = 1 << 20;

// The least of several times, in microseconds: of a single thread, so what is above it is others' doing.
double least_us(const std::function<void()>& work) {
  double least = 1e300;
  for (int i = 0; i < 20; ++i) {
    const Stopwatch watch;
    work();
    least = std::min(least, watch.cpu_s() * 1e6);
  }
  return least;
}

void measure_builders(Json& rows, std::vector<std::vector<std::string>>& lines) {
  for (const std::string_view set : kVoxelSets) {
    const VoxelGrid grid = voxel_object(set);
    const auto row = [&](const char* builder, std::size_t bytes, const std::function<void()>& work) {
      const double us = least_us(work);
      rows.push_back({{"table", "build"}, {"set", set}, {"builder", builder}, {"us", us}, {"bytes", bytes}});
      lines.push_back({std::string(set), builder, short_number(us), short_number(bytes)});
    };
    const std::size_t cubes = EmptyCubes(grid).bytes();
    row("cubes, bit-parallel", cubes, [&] { EmptyCubes(grid, CubeBuilder::bit_parallel); });
    row("cubes, two-pass", cubes, [&] { EmptyCubes(grid, CubeBuilder::two_pass); });
    row("cubes, summed-area", cubes, [&] { EmptyCubes(grid, CubeBuilder::summed_area); });
    row("spheres", EmptySpheres(grid).bytes(), [&] { EmptySpheres{grid}; });
    row("octants", OctantCubes(grid).bytes(), [&] { OctantCubes{grid}; });
    row("bricks", BrickMasks(grid).bytes(), [&] { BrickMasks{grid}; });
  }
}

// A march with the part of each object that it follows rays in.
struct Technique {
  const MarchEntry* march;
  VoxelModel::Extent extent;
};

Json measure_frame(std::string_view set, int n, const Technique& technique, const std::vector<Ray>& rays,
                   const VoxelsOptions& options) {
  VoxelGrid grid = voxel_object(set);
  const std::size_t lossless = VoxelModel(grid, *technique.march, {}, technique.extent).bytes();
  grid.drop_hidden_entries();
  const auto model = std::make_shared<const VoxelModel>(std::move(grid), *technique.march, std::vector<VoxelColour>{},
                                                        technique.extent);
  const Stopwatch build;
  const VoxelScene scene({model}, object_places(n));
  const double scene_s = build.cpu_s();

  // What slow techniques leave out is spread evenly over the picture.
  VoxelSceneStats stats;
  std::size_t hits = 0;
  const Stopwatch probe;
  const std::size_t probes = std::max<std::size_t>(1, rays.size() / 64);
  for (std::size_t i = 0; i < probes; ++i) hits += scene.closest_hit(rays[i * 64 % rays.size()], &stats) ? 1 : 0;
  const double per_ray_s = probe.cpu_s() / static_cast<double>(probes);
  const auto every = static_cast<std::size_t>(
      std::max(1.0, std::ceil(per_ray_s * static_cast<double>(rays.size()) / options.pass_limit_s)));
  stats = {};
  hits = 0;
  std::size_t traced = 0;
  for (std::size_t i = 0; i < rays.size(); i += every, ++traced) hits += scene.closest_hit(rays[i], &stats) ? 1 : 0;

  std::vector<double> seconds;
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    const Stopwatch watch;
    std::size_t again = 0;
    for (std::size_t i = 0; i < rays.size(); i += every) again += scene.closest_hit(rays[i]) ? 1 : 0;
    seconds.push_back(watch.cpu_s());
    hits = std::max(hits, again);
  }
  const double count = static_cast<double>(traced), ray_s = median(seconds) / count;
  const double objects = static_cast<double>(scene.objects());
  return {{"table", "frame"},
          {"set", set},
          {"objects", scene.objects()},
          {"march", technique.march->name},
          {"box", technique.extent == VoxelModel::Extent::grid ? "grid" : "bounds"},
          {"ms_per_frame", ray_s * kPixels * 1e3},
          {"mrays_per_cpu_s", 1e-6 / ray_s},
          {"steps_per_ray", stats.steps / count},
          {"boxes_per_ray", stats.boxes / count},
          {"hit_share", static_cast<double>(hits) / count},
          {"bytes_per_object", model->bytes()},
          {"bytes_per_object_lossless", lossless},
          {"mib_per_1k_distinct", static_cast<double>(model->bytes()) * 1024 / kMiB},
          {"mib_per_1k_lossless", static_cast<double>(lossless) * 1024 / kMiB},
          {"mib_per_1k_instanced", static_cast<double>(scene.bytes()) / objects * 1024 / kMiB},
          {"scene_build_s", scene_s}};
}

}  // namespace

void run_voxels(const VoxelsOptions& options, const ReportOptions& report) {
  Json rows = Json::array();
  std::vector<std::vector<std::string>> builds{{"set", "builder", "us", "bytes"}};
  measure_builders(rows, builds);
  print_table(builds, 2);

  std::vector<Technique> techniques;
  for (const MarchEntry& march : voxel_marches().subspan(1)) {
    for (const auto extent : {VoxelModel::Extent::grid, VoxelModel::Extent::bounds})
      techniques.push_back({&march, extent});
  }
  const std::vector<Ray> rays = camera_rays(options.stride);
  std::vector<std::vector<std::string>> lines{{"set", "objects", "march", "box", "ms/frame", "Mrays/s", "steps/ray",
                                               "boxes/ray", "hits", "B/object", "lossless", "MiB/1k inst."}};
  for (const std::string& set : options.sets) {
    for (const int n : options.thousands) {
      for (const Technique& technique : techniques) {
        const Json row = measure_frame(set, n, technique, rays, options);
        lines.push_back({set, short_number(row["objects"]), row["march"], row["box"], short_number(row["ms_per_frame"]),
                         short_number(row["mrays_per_cpu_s"]), short_number(row["steps_per_ray"]),
                         short_number(row["boxes_per_ray"]), short_number(row["hit_share"]),
                         short_number(row["bytes_per_object"]), short_number(row["bytes_per_object_lossless"]),
                         short_number(row["mib_per_1k_instanced"])});
        rows.push_back(row);
      }
    }
  }
  print_table(lines, 4);
  write_json(report, rows);
}

}  // namespace scarp::bench
