// SPDX-License-Identifier: MIT
// Pictures of voxels that a Vulkan device draws, by both methods, compared with the rasteriser of quads and with
// triangles of the same device.
#include <gtest/gtest.h>

#include <memory>

#include "bench/voxel_sets.h"
#include "bench/voxel_triangles.h"
#include "scarp/scene/voxel_camera_vk.h"
#include "vk/device_under_test.h"

namespace scarp::bench {
namespace {

class PixelMatchOnDevice : public test::OnDevice {
 protected:
  void SetUp() override {
    OnDevice::SetUp();
    if (!IsSkipped() && !device().description().abilities.draws) GTEST_SKIP() << "the device does not draw";
  }

  void expect_match(std::string_view set, int thousands, const NamedFrame& view, std::string_view march) {
    SCOPED_TRACE(std::string(set) + ", " + view.name + ", " + std::string(march));
    const VoxelGrid grid = voxel_object(set);
    const std::vector<VoxelPlace> places = object_places(thousands);
    const RasterPicture quads = rasterise(grid, places, view.frame, kPixelMargin);
    VoxelTriangles triangles(device(), grid, places);
    triangles.draw(view.frame);
    const std::vector<Hit> drawn = triangles.drawn();
    const RasterPicture snapped = rasterise(grid, places, view.frame, triangles.snap(view.frame));
    const Scene scene(scene_voxels({{std::make_shared<const VoxelModel>(grid, find_voxel_march(march))}, places}));
    VoxelCamera camera(device(), scene);
    const std::vector<Ray> rays = rays_of(view.frame);
    for (const VoxelDrawingName& way : kVoxelDrawings) {
      std::vector<Hit> hits(rays.size());
      camera.look(way.drawing, picture_of(view.frame), rays, hits);
      const PixelMatch match = compare_with_quads(quads, hits, grid, 0.25, view.frame);
      EXPECT_EQ(match.differ, 0) << way.name << ": " << match.first;
      EXPECT_EQ(match.near_edge_wrong, 0) << way.name << ": " << match.first;
      EXPECT_GT(match.hits, 0);
      const TrianglesMatch beside = compare_with_triangles(snapped, drawn, hits, view.frame);
      EXPECT_EQ(beside.differ, 0) << way.name << ": " << beside.first;
      hits.assign(hits.size(), Hit{});
      EXPECT_GT(compare_with_triangles(snapped, drawn, hits, view.frame).differ, 0);
      // Otherwise mostly edges would be compared.
      EXPECT_LT(beside.near_edges, beside.pixels / 20);
    }
  }
};

TEST_F(PixelMatchOnDevice, MatchesTheReferencePicture) {
  expect_match("standard", 1, pixel_match_frames(320, 180)[0], "voxel-octants");
}

// Every object shows one to three quads.
TEST_F(PixelMatchOnDevice, MatchesFromInside) {
  expect_match("degenerate", 4, pixel_match_frames(320, 180).back(), "voxel-bricks");
}

}  // namespace
}  // namespace scarp::bench
