// SPDX-License-Identifier: MIT
// `scarp-bench pixel-match`: the requirement of the founding post that every technique matches its quads pixel by
// pixel. With a device, both of its drawing methods must also match triangles drawn by the same device.
#include "bench/pixel_match.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/voxel_sets.h"
#include "scarp/base/error.h"
#ifdef SCARP_BENCH_VULKAN
#include "bench/report.h"
#include "bench/voxel_triangles.h"
#include "scarp/scene/voxel_camera_vk.h"
#endif

namespace scarp::bench {
namespace {

// `pixel-match`: pictures of voxels compared with the same voxels drawn as quads.
struct PixelMatchOptions {
  std::vector<std::string> sets{"standard", "degenerate"};
  std::vector<int> thousands{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};  // of objects, the post's camera
  std::vector<std::string> marches{"voxel-bricks"};
  std::string cameras = "all";  // or "post"
  int width = 1920, height = 1080;
  std::string device;  // both drawing methods of a Vulkan device; empty: the CPU
};

using Json = nlohmann::ordered_json;

constexpr int kOtherThousands = 4;  // of objects, for all cameras except that of the post

// The hits of a picture, by one method.
struct Look {
  std::string way;
  std::vector<Hit> hits;
};

class Matches {
 public:
  explicit Matches(const PixelMatchOptions& options) : options_(options) {
#ifdef SCARP_BENCH_VULKAN
    if (!options.device.empty()) device_.emplace(DeviceSettings{.choice = options.device, .validation = true});
#endif
  }

  // `place`: "3 of 38", this picture among all.
  void match(const std::string& place, const std::string& set, int thousands, const NamedFrame& view) {
    const VoxelGrid grid = voxel_object(set);
    const std::vector<VoxelPlace> places = object_places(thousands);
    // A picture takes up to a minute, and the table comes last.
    fmt::print(stderr, "picture {}: {}, {} objects, camera {}\n", place, set, places.size(), view.name);
    const RasterPicture quads = rasterise(grid, places, view.frame, kPixelMargin);
    draw(grid, places, view.frame);
    for (const std::string& name : options_.marches) {
      const auto model = std::make_shared<const VoxelModel>(grid, find_voxel_march(name));
      const Scene scene(scene_voxels({{model}, places}));
      for (const Look& look : looks(scene, view.frame)) {
        const PixelMatch found =
            compare_with_quads(quads, look.hits, grid, places[0].world_from_grid[0][0], view.frame);
        add(set, places.size(), view, name, look, found);
      }
    }
  }

  // Throws Error if a pixel differs.
  void report(const ReportOptions& report) {
    print_table(lines_, 5);
    write_json(report, rows_);
#ifdef SCARP_BENCH_VULKAN
    if (device_) {
      const auto messages = device_->validation_messages();
      if (!messages.empty()) throw Error("pixel-match: " + messages.front());
    }
#endif
    if (wrong_ > 0) throw Error(fmt::format("pixel-match: {} pixels differ; the first: {}", wrong_, first_));
  }

 private:
  std::vector<Look> looks(const Scene& scene, const PictureFrame& frame) {
    std::vector<Look> looks;
#ifdef SCARP_BENCH_VULKAN
    if (device_) {
      const std::vector<Ray> rays = rays_of(frame);
      VoxelCamera camera(*device_, scene);
      for (const VoxelDrawingName& way : kVoxelDrawings) {
        looks.push_back({std::string(way.name), std::vector<Hit>(rays.size())});
        camera.look(way.drawing, picture_of(frame), rays, looks.back().hits);
      }
      return looks;
    }
#endif
    looks.push_back({"cpu", hits_of(scene, frame)});
    return looks;
  }

  void draw([[maybe_unused]] const VoxelGrid& grid, [[maybe_unused]] std::span<const VoxelPlace> places,
            [[maybe_unused]] const PictureFrame& frame) {
#ifdef SCARP_BENCH_VULKAN
    if (!device_) return;
    VoxelTriangles triangles(*device_, grid, places);
    triangles.draw(frame);
    drawn_ = triangles.drawn();
    snapped_ = rasterise(grid, places, frame, triangles.snap(frame));
#endif
  }

  void add(const std::string& set, std::size_t objects, const NamedFrame& view, const std::string& march,
           const Look& look, const PixelMatch& found) {
    wrong_ += found.differ + found.near_edge_wrong;
    std::string first = found.first;
    Json triangles, beside;
#ifdef SCARP_BENCH_VULKAN
    if (device_) {
      const TrianglesMatch match = compare_with_triangles(snapped_, drawn_, look.hits, view.frame);
      triangles = match.differ, beside = match.other;
      wrong_ += match.differ;
      if (first.empty()) first = match.first;
    }
#endif
    if (first_.empty() && !first.empty())
      first_ = fmt::format("{}, {} objects, {}, {}, {}: {}", set, objects, view.name, march, look.way, first);
    rows_.push_back({{"set", set},
                     {"objects", objects},
                     {"camera", view.name},
                     {"march", march},
                     {"way", look.way},
                     {"width", view.frame.width},
                     {"height", view.frame.height},
                     {"hits", found.hits},
                     {"near_edges", found.near_edges},
                     {"differ", found.differ},
                     {"near_edge_wrong", found.near_edge_wrong},
                     {"triangles_differ", triangles},
                     {"triangles_beside", beside},
                     {"ray_pixels", found.ray_pixels},
                     {"t_error", found.t_error}});
    lines_.push_back({set, short_number(objects), view.name, march, look.way, short_number(found.hits, 7),
                      short_number(found.near_edges, 7), short_number(found.differ),
                      short_number(found.near_edge_wrong), short_number(triangles), short_number(beside),
                      short_number(found.ray_pixels), short_number(found.t_error)});
  }

  const PixelMatchOptions& options_;
  Json rows_ = Json::array();
  std::vector<std::vector<std::string>> lines_{{"set", "objects", "camera", "march", "way", "hits", "near edges",
                                                "differ", "wrong near edges", "triangles differ", "beside", "ray px",
                                                "t error"}};
  std::int64_t wrong_ = 0;
  std::string first_;
#ifdef SCARP_BENCH_VULKAN
  std::optional<Device> device_;
  std::vector<Hit> drawn_;
  RasterPicture snapped_;
#endif
};

// Throws Error, after the report, when a pixel differs.
void run_pixel_match(const PixelMatchOptions& options, const ReportOptions& report) {
  Matches matches(options);
  const std::vector<NamedFrame> frames = pixel_match_frames(options.width, options.height);
  const std::size_t others = options.cameras == "all" ? frames.size() - 1 : 0;
  const std::size_t all = options.sets.size() * (options.thousands.size() + others);
  std::size_t done = 0;
  const auto match = [&](const std::string& set, int thousands, const NamedFrame& view) {
    matches.match(fmt::format("{} of {}", ++done, all), set, thousands, view);
  };
  for (const std::string& set : options.sets) {
    for (const int n : options.thousands) match(set, n, frames[0]);
    for (std::size_t i = 0; i < others; ++i) match(set, kOtherThousands, frames[i + 1]);
  }
  matches.report(report);
}

}  // namespace

void add_pixel_match(cli::Program& program) {
  auto [command, o] = add_command<PixelMatchOptions>(
      program, "pixel-match", "Pictures of voxels beside the same drawn as quads; fails if a pixel differs",
      run_pixel_match);
  command.add(cli::List<std::string>{&o.sets}, {.names = "--sets",
                                                .help = "sets of objects",
                                                .choices = {"standard", "degenerate", "far-wall"},
                                                .closed = true});
  command.add(cli::List<int>{&o.thousands}, {.names = "--thousands", .help = "thousands of objects", .range = {1, 16}});
  command.add(cli::List<std::string>{&o.marches}, {.names = "--marches", .help = "voxel marches"});
  command.add(&o.cameras,
              {.names = "--cameras", .value = "WHICH", .help = "cameras", .choices = {"post", "all"}, .closed = true});
  command.add(&o.width, {.names = "--width", .help = "pixels", .range = {2, 2048}});
  command.add(&o.height, {.names = "--height", .help = "pixels", .range = {2, 2048}});
#ifdef SCARP_BENCH_VULKAN
  command.add(&o.device, {.names = "--device",
                          .value = "NAME",
                          .help = "both ways of drawing of a Vulkan device instead of the CPU, and its triangles",
                          .note = "cpu, gpu, auto or part of a name"});
#endif
}

}  // namespace scarp::bench
