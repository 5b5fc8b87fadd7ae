// SPDX-License-Identifier: MIT
// `scarp-bench voxel-models`: all marches over the models of voxel files: building, memory, single rays and batches.
#include <array>
#include <filesystem>
#include <glm/geometric.hpp>
#include <memory>
#include <random>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/protocol.h"
#include "bench/report.h"
#include "bench/trace_options.h"
#include "bench/voxel_sets.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/parallel.h"
#include "scarp/scene/file/from_volume.h"
#include "scarp/scene/file/from_vox.h"
#include "scarp/scene/scene.h"

namespace scarp::bench {
namespace {

// `voxel-models`: all voxel marches over models from files.
struct VoxelModelsOptions {
  std::vector<std::string> files;  // .vox and .binvox
  int width = 256;                 // pixels per side of the pictures, from eight sides
  int repeats = 5;
};

using Json = nlohmann::ordered_json;

constexpr double kBytesPerMiB = 1 << 20;

PlacedVoxels placed_in(const std::string& path) {
  VoxelFileOptions options;
  options.march = "voxel-planes";
  if (extension_of(path) == ".binvox") {
    FromVolumeOptions from;
    from.voxels = options;
    return placed_voxels_from(read_binvox(path), kPlainVoxels, from);
  }
  return placed_voxels_from(read_vox(path), {{}, options});
}

// A march with all models of the file built for it.
struct Built {
  const VoxelMarchEntry* march;
  std::vector<double> build_s{};
  std::unique_ptr<Scene> scene{};

  void build(const PlacedVoxels& voxels) {
    PlacedVoxels own{.places = voxels.places};
    double seconds = 0;
    for (const auto& model : voxels.models) {
      VoxelGrid grid = model->grid();
      const Stopwatch watch;
      own.models.push_back(std::make_shared<const VoxelModel>(std::move(grid), *march));
      seconds += watch.cpu_s();
    }
    build_s.push_back(seconds);
    scene = std::make_unique<Scene>(scene_voxels(std::move(own)));
  }
};

// Rays of a picture from eight sides; from their hits, rays to a sun, and random rays to the sky.
struct RayClasses {
  std::vector<Ray> camera, sun, sky;
  std::vector<Hit> hits;         // hits of camera rays
  std::vector<const Hit*> from;  // likewise

  RayClasses(const Scene& scene, int width) {
    const WorldBox& box = scene.box();
    camera = octant_rays(box.high - box.low, width);
    for (Ray& ray : camera) ray.origin += box.low;
    std::vector<Hit> all(camera.size());
    scene.closest_hits(camera, all);
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < camera.size(); ++i) {
      if (!all[i]) continue;
      hits.push_back(all[i]);
      const dvec3 point = camera[i].at(all[i].t);
      dvec3 to_sky = normalize(dvec3(normal(random), normal(random), normal(random)));
      if (dot(to_sky, scene.surface(camera[i], all[i]).normal) < 0) to_sky = -to_sky;
      sun.push_back({.origin = point, .direction = normalize(dvec3(0.4, -0.6, 0.7))});
      sky.push_back({.origin = point, .direction = to_sky});
    }
    for (const Hit& hit : hits) from.push_back(&hit);
  }
};

void run_voxel_models(const VoxelModelsOptions& options, const ReportOptions& report) {
  const ThreadLimit limit(1);
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"file", "models", "Mvoxels", "march", "build ms", "MiB", "single M/s",
                                               "camera M/s", "sun M/s", "sky M/s", "hits"}};
  for (const std::string& path : options.files) {
    const PlacedVoxels voxels = placed_in(path);
    std::int64_t size = 0;
    for (const auto& model : voxels.models) {
      const ivec3& s = model->grid().size();
      size += std::int64_t{s.x} * s.y * s.z;
    }
    std::vector<Built> engines;
    for (const VoxelMarchEntry& march : voxel_marches().subspan(1)) {
      Built engine{&march};
      try {
        engine.build(voxels);
      } catch (const Error&) {
        continue;  // the model is too large for this march
      }
      engines.push_back(std::move(engine));
    }
    const RayClasses rays(*engines.front().scene, options.width);
    std::vector<Hit> hits(rays.camera.size());
    std::vector<std::uint8_t> blocked(rays.hits.size());
    // Seconds per ray, by engine and class.
    std::vector<std::array<std::vector<double>, 4>> seconds(engines.size());
    const auto time = [](std::vector<double>& into, std::size_t count, const auto& work) {
      const Stopwatch watch;
      work();
      into.push_back(watch.cpu_s() / static_cast<double>(count));
    };
    for (int repeat = 0; repeat <= options.repeats; ++repeat) {
      for (std::size_t e = 0; e < engines.size(); ++e) {
        engines[e].build(voxels);
        const Scene& scene = *engines[e].scene;
        auto& of = seconds[e];
        time(of[0], rays.camera.size(), [&] {
          for (std::size_t i = 0; i < rays.camera.size(); ++i) hits[i] = scene.closest_hit(rays.camera[i]);
        });
        time(of[1], rays.camera.size(), [&] { scene.closest_hits(rays.camera, hits); });
        time(of[2], rays.sun.size(), [&] { scene.occluded(rays.sun, blocked, rays.from); });
        time(of[3], rays.sky.size(), [&] { scene.occluded(rays.sky, blocked, rays.from); });
      }
    }
    for (std::size_t e = 0; e < engines.size(); ++e) {
      const auto million_per_s = [&](std::size_t of) {
        // The first pass is a warm-up.
        return 1e-6 / median({seconds[e][of].begin() + 1, seconds[e][of].end()});
      };
      Json row = {{"file", std::filesystem::path(path).filename().string()},
                  {"models", voxels.models.size()},
                  {"mvoxels", 1e-6 * static_cast<double>(size)},
                  {"march", engines[e].march->name},
                  {"build_ms", 1e3 * median(engines[e].build_s)},
                  {"mib", static_cast<double>(engines[e].scene->only_field()->bytes()) / kBytesPerMiB},
                  {"single_mrays_per_cpu_s", million_per_s(0)},
                  {"camera_mrays_per_cpu_s", million_per_s(1)},
                  {"sun_mrays_per_cpu_s", million_per_s(2)},
                  {"sky_mrays_per_cpu_s", million_per_s(3)},
                  {"hit_share", static_cast<double>(rays.hits.size()) / static_cast<double>(rays.camera.size())}};
      std::vector<std::string> line;
      for (const auto& value : row) line.push_back(value.is_string() ? value.get<std::string>() : short_number(value));
      lines.push_back(std::move(line));
      rows.push_back(std::move(row));
    }
  }
  print_table(lines, 4);
  write_json(report, rows);
}

}  // namespace

void add_voxel_models(cli::Program& program) {
  auto [command, o] = add_command<VoxelModelsOptions>(
      program, "voxel-models", "All voxel marches over the models of files: building, memory, speed", run_voxel_models);
  command.add(&o.files, {.names = "FILE", .help = ".vox and .binvox", .files = "vox binvox", .required = true});
  command.add(&o.width,
              {.names = "--width", .help = "pixels per side of the pictures, a multiple of 8", .range = {8, 2048}});
  add_repeats_option(command, o.repeats);
}

}  // namespace scarp::bench
