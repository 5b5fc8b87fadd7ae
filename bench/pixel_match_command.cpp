// SPDX-License-Identifier: MIT
// `scarp-bench pixel-match`: the founding post's demand, that every technique matches its quads pixel by pixel.
#include "bench/pixel_match.h"

#include <fmt/format.h>

#include <memory>

#include "bench/commands.h"
#include "bench/voxel_sets.h"
#include "scarp/base/error.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kOtherThousands = 4;  // of objects, for all cameras but the post's

}  // namespace

void run_pixel_match(const PixelMatchOptions& options, const ReportOptions& report) {
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{
      {"set", "objects", "camera", "march", "hits", "near edges", "differ", "wrong near edges", "ray px", "t error"}};
  std::int64_t wrong = 0;
  std::string first;
  const auto match = [&](const std::string& set, int thousands, const NamedFrame& view) {
    const VoxelGrid grid = voxel_object(set);
    const std::vector<VoxelPlace> places = object_places(thousands);
    const RasterPicture quads = rasterise(grid, places, view.frame, kPixelMargin);
    for (const std::string& name : options.marches) {
      const auto model = std::make_shared<const VoxelModel>(grid, find_voxel_march(name));
      const Scene scene(scene_voxels({{model}, places}));
      const PixelMatch found = compare_with_quads(quads, scene, grid, places[0].world_from_grid[0][0], view.frame);
      wrong += found.differ + found.near_edge_wrong;
      if (first.empty() && !found.first.empty())
        first = fmt::format("{}, {}k, {}, {}: {}", set, thousands, view.name, name, found.first);
      rows.push_back({{"set", set},
                      {"objects", places.size()},
                      {"camera", view.name},
                      {"march", name},
                      {"width", view.frame.width},
                      {"height", view.frame.height},
                      {"hits", found.hits},
                      {"near_edges", found.near_edges},
                      {"differ", found.differ},
                      {"near_edge_wrong", found.near_edge_wrong},
                      {"ray_pixels", found.ray_pixels},
                      {"t_error", found.t_error}});
      lines.push_back({set, short_number(places.size()), view.name, name, short_number(found.hits, 7),
                       short_number(found.near_edges, 7), short_number(found.differ),
                       short_number(found.near_edge_wrong), short_number(found.ray_pixels),
                       short_number(found.t_error)});
    }
  };
  const std::vector<NamedFrame> frames = pixel_match_frames(options.width, options.height);
  for (const std::string& set : options.sets) {
    for (const int n : options.thousands) match(set, n, frames[0]);
    if (options.cameras == "all") {
      for (std::size_t i = 1; i < frames.size(); ++i) match(set, kOtherThousands, frames[i]);
    }
  }
  print_table(lines, 4);
  write_json(report, rows);
  if (wrong > 0) throw Error(fmt::format("pixel-match: {} pixels differ; the first: {}", wrong, first));
}

}  // namespace scarp::bench
