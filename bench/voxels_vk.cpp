// SPDX-License-Identifier: MIT
// `scarp-bench voxels --device NAME`: the pictures of the founding post on a Vulkan device, by both drawing methods and
// every march, compared with their quads drawn by the same device as triangles. Times are those of the device's clock.
//
// Boxes are around grids, as in the post, or tight, around solid voxels. All objects share a grid; a column shows the
// memory of 1,024 objects with separate grids.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "bench/device_seconds.h"
#include "bench/pixel_match.h"
#include "bench/protocol.h"
#include "bench/report.h"
#include "bench/voxel_sets.h"
#include "bench/voxel_triangles.h"
#include "bench/voxels_options.h"
#include "scarp/base/error.h"
#include "scarp/scene/voxel_camera_vk.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMiB = 1 << 20;
constexpr double kMilliseconds = 1e3;  // in a second

// Number of hits that differ from the CPU's.
std::size_t count_wrong(std::span<const Hit> hits, std::span<const Hit> expected) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit &a = hits[i], &b = expected[i];
    wrong += !(static_cast<bool>(a) == static_cast<bool>(b) &&
               (!a || (a.t == b.t && a.part == b.part && a.voxel == b.voxel && a.face == b.face)));
  }
  return wrong;
}

class DeviceTables {
 public:
  // `device` and `drawing` are the same device, opened twice: gpu_raster.cpp explains why.
  DeviceTables(const VoxelsOptions& options, const Device& device, const Device& drawing)
      : options_(options), device_(device), drawing_(drawing) {}

  void measure(const std::string& set, int n) {
    const PictureFrame frame = pixel_match_frames(options_.height * 16 / 9, options_.height)[0].frame;
    const std::vector<Ray> rays = rays_of(frame);
    const std::vector<VoxelPlace> places = object_places(n);
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    const VoxelPicture picture = picture_of(frame);
    for (const VoxelMarchEntry& march : voxel_marches()) {
      if (!march.gpu) continue;
      for (const auto extent : {VoxelModel::Extent::grid, VoxelModel::Extent::bounds}) {
        VoxelGrid grid = voxel_object(set);
        grid.drop_hidden_entries();
        const auto model =
            std::make_shared<const VoxelModel>(std::move(grid), march, std::vector<VoxelColour>{}, extent);
        const Scene scene(scene_voxels({{model}, places}));
        // Rays are quantised at the box, so t depends on it.
        scene.closest_hits(rays, expected);
        const auto steps_and_boxes = costs(scene, rays);
        for (const VoxelDrawingName& way : kVoxelDrawings) {
          const bool proxies = way.drawing == VoxelDrawing::proxies;
          VoxelCamera camera(proxies ? drawing_ : device_, scene,
                             {.rays_at_once = static_cast<std::uint32_t>(std::min<std::size_t>(rays.size(), 1 << 21))});
          std::vector<double> times;
          for (int pass = 0; pass <= options_.repeats; ++pass) {
            camera.look(way.drawing, picture, rays, hits);
            if (pass > 0) times.push_back(kMilliseconds * device_seconds(device_, camera.passes()));
          }
          const VoxelCamera::Bytes bytes = camera.bytes();
          Json row = head(set, places.size());
          row["engine"] = march.name;
          row["way"] = way.name;
          row["box"] = extent == VoxelModel::Extent::grid ? "grid" : "bounds";
          row["ms"] = median(times);
          row["steps_per_ray"] = steps_and_boxes.first;
          row["boxes_per_ray"] = proxies ? Json() : Json(steps_and_boxes.second);
          row["again_per_million"] =
              proxies ? Json(1e6 * static_cast<double>(camera.tied()) / static_cast<double>(rays.size())) : Json();
          row["hit_share"] = share_of(expected);
          row["wrong"] = count_wrong(hits, expected);
          row["device_mib"] = static_cast<double>(bytes.grids + bytes.objects) / kMiB;
          row["mib_per_1k_distinct"] = static_cast<double>(bytes.grids) * 1024 / kMiB;
          row["picture_mib"] = static_cast<double>(bytes.pictures) / kMiB;
          add(std::move(row));
        }
      }
    }
    measure_triangles(set, frame, places);
  }

  void report(const ReportOptions& report) {
    print_table(lines_, 4);
    write_json(report, rows_);
  }

 private:
  Json head(const std::string& set, std::size_t objects) const {
    return {{"table", "device"}, {"set", set}, {"objects", objects}, {"height", options_.height}};
  }

  void measure_triangles(const std::string& set, const PictureFrame& frame, const std::vector<VoxelPlace>& places) {
    VoxelTriangles triangles(drawing_, voxel_object(set), places);
    std::vector<double> times;
    for (int pass = 0; pass <= options_.repeats; ++pass) {
      triangles.draw(frame);
      if (pass > 0) times.push_back(kMilliseconds * device_seconds(device_, triangles.passes()));
    }
    Json row = head(set, places.size());
    row["engine"] = "triangles";
    row["way"] = fmt::format("{} per object", triangles.triangles());
    row["ms"] = median(times);
    row["hit_share"] = share_of(triangles.drawn());
    row["device_mib"] = static_cast<double>(triangles.bytes()) / kMiB;
    add(std::move(row));
  }

  // Costs of the compute method, counted on the CPU, which takes the same steps in the same boxes.
  static std::pair<double, double> costs(const Scene& scene, const std::vector<Ray>& rays) {
    MarchStats sum;
    std::size_t asked = 0;
    for (std::size_t i = 0; i < rays.size(); i += 37, ++asked) {
      MarchStats stats;
      scene.closest_hit(rays[i], nullptr, &stats);
      sum.steps += stats.steps, sum.boxes += stats.boxes;
    }
    return {static_cast<double>(sum.steps) / static_cast<double>(asked),
            static_cast<double>(sum.boxes) / static_cast<double>(asked)};
  }

  static double share_of(std::span<const Hit> hits) {
    std::size_t count = 0;
    for (const Hit& hit : hits) count += hit ? 1 : 0;
    return static_cast<double>(count) / static_cast<double>(hits.size());
  }

  void add(Json row) {
    std::vector<std::string> line;
    for (const char* key : {"set", "objects", "engine", "way", "box", "ms", "steps_per_ray", "boxes_per_ray",
                            "again_per_million", "hit_share", "wrong", "device_mib", "mib_per_1k_distinct"}) {
      const Json value = row.value(key, Json());
      line.push_back(value.is_string() ? value.get<std::string>() : value.is_null() ? "-" : short_number(value));
    }
    lines_.push_back(std::move(line));
    row["device"] = device_.description().name;
    row["driver"] = device_.description().driver;
    rows_.push_back(std::move(row));
  }

  const VoxelsOptions& options_;
  Device device_, drawing_;
  Json rows_ = Json::array();
  std::vector<std::vector<std::string>> lines_{{"set", "objects", "engine", "way", "box", "ms/frame", "steps/ray",
                                                "boxes/ray", "again ppm", "hits", "wrong", "MiB", "MiB/1k distinct"}};
};

}  // namespace

void run_device_voxels(const VoxelsOptions& options, const ReportOptions& report) {
  const Device device({.choice = options.device}), drawing({.choice = options.device});
  const DeviceDescription& description = device.description();
  fmt::print("{}, {}; {} x {} pixels\n", description.name, description.driver, options.height * 16 / 9, options.height);
  if (!description.abilities.timestamps)
    throw Error(fmt::format("device '{}': has no timestamps, by which voxels measures", description.name));
  DeviceTables tables(options, device, drawing);
  for (const std::string& set : options.sets) {
    for (const int n : options.thousands) tables.measure(set, n);
  }
  tables.report(report);
}

}  // namespace scarp::bench
