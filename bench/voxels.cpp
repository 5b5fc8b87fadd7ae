// SPDX-License-Identifier: MIT
// `scarp-bench voxels`: the tables of the founding post for the marches of voxel grids: time per frame, memory, steps
// and boxes per ray, build times; compared with Embree, NanoVDB and a hash for colours.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/trace_options.h"
#include "bench/voxels_options.h"
#ifdef SCARP_BENCH_NANOVDB
#include "bench/nanovdb_peer.h"
#endif
#include "bench/protocol.h"
#include "bench/report.h"
#include "bench/voxel_embree_peer.h"
#include "bench/voxel_hash.h"
#include "bench/voxel_sets.h"
#include "scarp/accel/brick_masks.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/scene/scene.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPixels = 1920.0 * 1080.0;
constexpr double kMiB = 1 << 20;
constexpr std::size_t kTileRays = 64;

std::string text_of(const Json& value) { return value.is_string() ? value.get<std::string>() : short_number(value); }

// The least of several times, in microseconds: on a single thread, where any excess is due to other processes.
double least_us(const std::function<void()>& work, int times = 20) {
  double least = 1e300;
  for (int i = 0; i < times; ++i) {
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
    row("cubes, rows", cubes, [&] { EmptyCubes(grid, CubeBuilder::rows); });
    row("cubes, bit-parallel", cubes, [&] { EmptyCubes(grid, CubeBuilder::bit_parallel); });
    row("cubes, summed-area", cubes, [&] { EmptyCubes(grid, CubeBuilder::summed_area); });
    row("spheres", EmptySpheres(grid).bytes(), [&] { EmptySpheres{grid}; });
    row("octants", OctantCubes(grid).bytes(), [&] { OctantCubes{grid}; });
    row("bricks", BrickMasks(grid).bytes(), [&] { BrickMasks{grid}; });
  }
}

// Colours by rank, as in VoxelGrid, compared with a perfect spatial hash: bytes, and time per colour in the order in
// which the camera's rays hit.
void measure_colours(Json& rows, std::vector<std::vector<std::string>>& lines) {
  for (const bool surface : {true, false}) {
    VoxelGrid grid = voxel_object("standard");
    const VoxelHash hash(grid, surface);
    const double shape = static_cast<double>(grid.masks().size_bytes());
    const double hash_us = least_us([&] { VoxelHash{grid, surface}; }, 1);
    VoxelGrid ranked = grid;
    if (surface) ranked.drop_hidden_entries();
    const double rank_us = least_us([&] {
      VoxelGrid again = grid;
      again.drop_hidden_entries();
    });
    std::vector<ivec3> asked;
    const auto model = std::make_shared<const VoxelModel>(grid, find_voxel_march("voxel-planes"));
    const Scene scene(scene_voxels({{model}, {VoxelPlace{}}}));
    for (const Ray& ray : octant_rays(dvec3(grid.size()), 64)) {
      if (const Hit hit = scene.closest_hit(ray)) asked.push_back(hit.voxel);
    }
    std::uint64_t sum_rank = 0, sum_hash = 0;
    const double count = static_cast<double>(asked.size());
    const double rank_ns = 1e3 / count * least_us([&] {
                             for (const ivec3& v : asked) sum_rank += ranked.entry(v);
                           });
    const double hash_ns = 1e3 / count * least_us([&] {
                             for (const ivec3& v : asked) sum_hash += hash.entry(v);
                           });
    if (sum_rank != sum_hash) throw Error("voxels: the hash has other colours than the ranks");
    const char* of = surface ? "surface" : "all";
    const auto row = [&](const char* way, double bytes, double ns, double us) {
      rows.push_back({{"table", "colours"}, {"of", of}, {"way", way}, {"bytes", bytes}, {"ns", ns}, {"us", us}});
      lines.push_back({of, way, short_number(bytes), short_number(ns), short_number(us)});
    };
    // Both exclude the shape itself, which marches need; rank includes the mask of coloured voxels.
    row("rank", static_cast<double>(ranked.bytes()) - shape, rank_ns, rank_us);
    row("hash", static_cast<double>(hash.bytes()), hash_ns, hash_us);
  }
}

// Medians over passes of all engines in turn. Each pass has as many tiles of 64 rays as the engine can trace in time.
struct Measured {
  double ray_s = 0;
  std::size_t rays = 0, hits = 0;
  std::size_t lost = 0, other = 0;  // hits of the first engine that it does not report, or reports for another voxel
};

std::vector<Measured> measure_engines(const std::vector<VoxelEngine>& engines, const std::vector<Ray>& rays,
                                      const VoxelsOptions& options) {
  std::vector<Measured> measured(engines.size());
  std::vector<std::vector<Ray>> own(engines.size());
  std::vector<Hit> expected(rays.size()), answers;
  engines[0].trace(rays, expected);
  for (std::size_t e = 0; e < engines.size(); ++e) {
    const auto part = [&](std::size_t every) {
      own[e].clear();
      for (std::size_t tile = 0; tile < rays.size() / kTileRays; tile += every)
        own[e].insert(own[e].end(), &rays[tile * kTileRays], &rays[tile * kTileRays] + kTileRays);
      answers.resize(own[e].size());
      const Stopwatch watch;
      engines[e].trace(own[e], answers);
      return watch.cpu_s();
    };
    // Slow techniques skip rays evenly over the picture.
    const double probe_s = part(32) * static_cast<double>(rays.size()) / static_cast<double>(own[e].size());
    const auto every = static_cast<std::size_t>(std::max(1.0, std::ceil(probe_s / options.pass_limit_s)));
    part(every);
    Measured& m = measured[e];
    m.rays = own[e].size();
    for (std::size_t i = 0; i < own[e].size(); ++i) {
      const Hit& right = expected[i / kTileRays * every * kTileRays + i % kTileRays];
      m.hits += answers[i] ? 1 : 0;
      const bool same = static_cast<bool>(right) == static_cast<bool>(answers[i]) &&
                        (!right || (right.part == answers[i].part && right.voxel == answers[i].voxel));
      if (!same) ++(right && !answers[i] ? m.lost : m.other);
    }
  }
  std::vector<std::vector<double>> seconds(engines.size());
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    for (std::size_t e = 0; e < engines.size(); ++e) {
      answers.resize(own[e].size());
      const Stopwatch watch;
      engines[e].trace(own[e], answers);
      seconds[e].push_back(watch.cpu_s());
    }
  }
  for (std::size_t e = 0; e < engines.size(); ++e)
    measured[e].ray_s = median(seconds[e]) / static_cast<double>(own[e].size());
  return measured;
}

// A scene as two engines: ray by ray, and in batches.
void add_engines(const Scene& scene, std::string_view march, const char* box, std::vector<VoxelEngine>& engines) {
  VoxelEngine engine;
  engine.name = march, engine.mode = "x1", engine.box = box;
  engine.mib = static_cast<double>(scene.only_field()->bytes()) / kMiB;
  engine.trace = [&scene](std::span<const Ray> rays, std::span<Hit> hits) {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = scene.closest_hit(rays[i]);
  };
  engines.push_back(engine);
  engine.mode = "x64";
  engine.trace = [&scene](std::span<const Ray> rays, std::span<Hit> hits) { scene.closest_hits(rays, hits); };
  engines.push_back(engine);
}

// Measures the scene of the post with every technique and the peers.
void measure_frame(const std::string& set, int n, const VoxelsOptions& options, Json& rows,
                   std::vector<std::vector<std::string>>& lines) {
  struct Technique {
    std::unique_ptr<Scene> scene;
    double bytes, lossless, build_s;
  };
  const std::vector<Ray> rays = camera_rays(options.stride);
  const std::vector<VoxelPlace> places = object_places(n);
  std::vector<Technique> techniques;
  std::vector<VoxelEngine> engines;
  for (const VoxelMarchEntry& march : voxel_marches().subspan(1)) {
    for (const auto extent : {VoxelModel::Extent::grid, VoxelModel::Extent::bounds}) {
      VoxelGrid grid = voxel_object(set);
      const std::size_t lossless = VoxelModel(grid, march, {}, extent).bytes();
      grid.drop_hidden_entries();
      const auto model = std::make_shared<const VoxelModel>(std::move(grid), march, std::vector<VoxelColour>{}, extent);
      const Stopwatch build;
      auto scene = std::make_unique<Scene>(scene_voxels({{model}, places}));
      techniques.push_back(
          {std::move(scene), static_cast<double>(model->bytes()), static_cast<double>(lossless), build.cpu_s()});
      add_engines(*techniques.back().scene, march.name, extent == VoxelModel::Extent::grid ? "grid" : "bounds",
                  engines);
    }
  }
  const VoxelGrid grid = voxel_object(set);
  const auto model = std::make_shared<const VoxelModel>(grid, find_voxel_march("voxel-octants"));
  const VoxelEmbreePeer user = VoxelEmbreePeer::user_geometry(model, places),
                        triangles = VoxelEmbreePeer::triangles(grid, places);
  for (const VoxelEmbreePeer* peer : {&user, &triangles}) {
    for (VoxelEngine& engine : peer->engines()) engines.push_back(std::move(engine));
  }

  const std::vector<Measured> measured = measure_engines(engines, rays, options);
  for (std::size_t e = 0; e < engines.size(); ++e) {
    const VoxelEngine& engine = engines[e];
    const Measured& m = measured[e];
    const double count = static_cast<double>(m.rays);
    Json row = {{"table", "frame"},
                {"set", set},
                {"objects", places.size()},
                {"engine", engine.name},
                {"mode", engine.mode},
                {"box", engine.box},
                {"ms_per_frame", m.ray_s * kPixels * 1e3},
                {"mrays_per_cpu_s", 1e-6 / m.ray_s},
                {"hit_share", static_cast<double>(m.hits) / count},
                {"lost_ppm", 1e6 * static_cast<double>(m.lost) / count},
                {"other_ppm", 1e6 * static_cast<double>(m.other) / count},
                {"main_mib", engine.mib}};
    if (e / 2 < techniques.size()) {
      const Technique& t = techniques[e / 2];
      MarchStats stats;
      std::size_t asked = 0;
      // Steps are the same in batches.
      for (std::size_t i = 0; i < rays.size(); i += 7, ++asked) {
        MarchStats of_ray;
        t.scene->closest_hit(rays[i], nullptr, &of_ray);
        stats.steps += of_ray.steps, stats.boxes += of_ray.boxes;
      }
      row["steps_per_ray"] = static_cast<double>(stats.steps) / static_cast<double>(asked);
      row["boxes_per_ray"] = static_cast<double>(stats.boxes) / static_cast<double>(asked);
      row["bytes_per_object"] = t.bytes;
      row["bytes_per_object_lossless"] = t.lossless;
      row["mib_per_1k_distinct"] = t.bytes * 1024 / kMiB;
      row["mib_per_1k_lossless"] = t.lossless * 1024 / kMiB;
      row["mib_per_1k_instanced"] = (static_cast<double>(t.scene->only_field()->bytes()) - t.bytes) /
                                    static_cast<double>(places.size()) * 1024 / kMiB;
      row["scene_build_s"] = t.build_s;
    }
    std::vector<std::string> line;
    for (const char* key :
         {"set", "objects", "engine", "mode", "box", "ms_per_frame", "mrays_per_cpu_s", "steps_per_ray",
          "boxes_per_ray", "hit_share", "lost_ppm", "other_ppm", "main_mib", "mib_per_1k_distinct"})
      line.push_back(text_of(row.value(key, Json())));
    lines.push_back(std::move(line));
    rows.push_back(std::move(row));
  }
}

// Measures a single grid: all marches, and NanoVDB over the same voxels with the same rays.
void measure_grid(const char* name, const VoxelGrid& grid, const VoxelsOptions& options, Json& rows,
                  std::vector<std::vector<std::string>>& lines) {
  const std::vector<Ray> rays = octant_rays(dvec3(grid.size()), options.width);
  std::vector<std::unique_ptr<Scene>> scenes;
  std::vector<VoxelEngine> engines;
  for (const VoxelMarchEntry& march : voxel_marches().subspan(1)) {
    const auto model = std::make_shared<const VoxelModel>(grid, march);
    scenes.push_back(std::make_unique<Scene>(scene_voxels({{model}, {VoxelPlace{}}})));
    add_engines(*scenes.back(), march.name, "bounds", engines);
  }
#ifdef SCARP_BENCH_NANOVDB
  const NanovdbPeer nanovdb(grid);
  for (VoxelEngine& engine : nanovdb.engines()) engines.push_back(std::move(engine));
#endif
  const std::vector<Measured> measured = measure_engines(engines, rays, options);
  for (std::size_t e = 0; e < engines.size(); ++e) {
    const Measured& m = measured[e];
    const double count = static_cast<double>(m.rays);
    Json row = {{"table", "grid"},
                {"set", name},
                {"engine", engines[e].name},
                {"mode", engines[e].mode},
                {"mrays_per_cpu_s", 1e-6 / m.ray_s},
                {"hit_share", static_cast<double>(m.hits) / count},
                {"lost_ppm", 1e6 * static_cast<double>(m.lost) / count},
                {"other_ppm", 1e6 * static_cast<double>(m.other) / count},
                {"main_mib", engines[e].mib}};
    std::vector<std::string> line;
    for (const char* key :
         {"set", "engine", "mode", "mrays_per_cpu_s", "hit_share", "lost_ppm", "other_ppm", "main_mib"})
      line.push_back(text_of(row.value(key, Json())));
    lines.push_back(std::move(line));
    rows.push_back(std::move(row));
  }
}

// Objects of the standard set side by side, as one grid.
VoxelGrid block_of(const ivec3& objects) {
  const VoxelGrid object = voxel_object("standard");
  VoxelGrid grid(objects * kObjectSide, 1);
  grid.edit(grid.box(), [&](const ivec3& v, const VoxelGrid::Voxel&) {
    return object.solid(v & (kObjectSide - 1)) ? VoxelGrid::Voxel(1) : VoxelGrid::Voxel();
  });
  return grid;
}

void run_voxels(const VoxelsOptions& options, const ReportOptions& report) {
  const ThreadLimit limit(1);
  Json rows = Json::array();
  std::vector<std::vector<std::string>> builds{{"set", "builder", "us", "bytes"}};
  measure_builders(rows, builds);
  print_table(builds, 2);
  std::vector<std::vector<std::string>> colours{{"colours of", "way", "bytes", "ns", "build us"}};
  measure_colours(rows, colours);
  print_table(colours, 2);
  std::vector<std::vector<std::string>> grids{
      {"grid", "engine", "mode", "Mrays/s", "hits", "lost ppm", "other ppm", "MiB"}};
  measure_grid("object", voxel_object("standard"), options, rows, grids);
  measure_grid("block", block_of(ivec3(options.block)), options, rows, grids);
  print_table(grids, 3);
  std::vector<std::vector<std::string>> lines{{"set", "objects", "engine", "mode", "box", "ms/frame", "Mrays/s",
                                               "steps/ray", "boxes/ray", "hits", "lost ppm", "other ppm", "MiB",
                                               "MiB/1k distinct"}};
  for (const std::string& set : options.sets) {
    for (const int n : options.thousands) measure_frame(set, n, options, rows, lines);
  }
  print_table(lines, 5);
  write_json(report, rows);
}

}  // namespace

void add_voxels(cli::Program& program) {
  auto [command, o] =
      add_command<VoxelsOptions>(program, "voxels", "The founding post's tables: 1k to 16k objects of 32^3 voxels",
                                 [](const VoxelsOptions& options, const ReportOptions& report) {
#ifdef SCARP_BENCH_VULKAN
                                   if (!options.device.empty()) return run_device_voxels(options, report);
#endif
                                   run_voxels(options, report);
                                 });
  command.add(cli::List<std::string>{&o.sets},
              {.names = "--sets", .help = "sets of objects", .choices = o.sets, .closed = true});
  command.add(cli::List<int>{&o.thousands}, {.names = "--thousands", .help = "thousands of objects", .range = {1, 16}});
  command.add(&o.stride,
              {.names = "--stride", .help = "one tile of 8 x 8 pixels in N x N of 1920 x 1080", .range = {1, 64}});
  command.add(
      &o.width,
      {.names = "--width", .help = "pixels per side of the pictures of one grid, a multiple of 8", .range = {8, 2048}});
  command.add(&o.block,
              {.names = "--block", .help = "objects per side of the larger one of these grids", .range = {1, 16}});
  add_repeats_option(command, o.repeats);
  add_pass_limit_option(command, o.pass_limit_s, "a technique");
#ifdef SCARP_BENCH_VULKAN
  command.add(&o.device, {.names = "--device",
                          .value = "NAME",
                          .help = "instead: both ways of drawing of a Vulkan device, and its triangles",
                          .note = "cpu, gpu, auto or part of a name"});
  command.add(&o.height,
              {.names = "--height", .help = "pixels of the pictures of --device, 16 : 9", .range = {9, 1080}});
#endif
}

}  // namespace scarp::bench
