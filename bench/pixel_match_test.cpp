// SPDX-License-Identifier: MIT
// Pictures of voxels compared with the same voxels drawn as quads, and cases in which the rasteriser must find errors.
#include "bench/pixel_match.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/voxel_sets.h"
#include "scarp/base/error.h"

namespace scarp::bench {
namespace {

Scene scene_of(const VoxelGrid& grid, const std::vector<VoxelPlace>& places) {
  return Scene(scene_voxels({{std::make_shared<const VoxelModel>(grid, find_voxel_march("voxel-bricks"))}, places}));
}

PixelMatch expect_match(std::string_view set, int thousands, const NamedFrame& view) {
  const VoxelGrid grid = voxel_object(set);
  const std::vector<VoxelPlace> places = object_places(thousands);
  const RasterPicture quads = rasterise(grid, places, view.frame, kPixelMargin);
  const PixelMatch match =
      compare_with_quads(quads, hits_of(scene_of(grid, places), view.frame), grid, 0.25, view.frame);
  EXPECT_EQ(match.differ, 0) << set << ' ' << thousands << ' ' << view.name << ": " << match.first;
  EXPECT_EQ(match.near_edge_wrong, 0) << set << ' ' << thousands << ' ' << view.name << ": " << match.first;
  EXPECT_EQ(match.pixels, view.frame.width * view.frame.height);
  EXPECT_GT(match.hits, 0) << set << ' ' << view.name;
  return match;
}

TEST(PixelMatch, MatchesTheReferencePictures) {
  for (const char* set : {"standard", "degenerate"}) {
    for (const int thousands : {1, 4}) {
      const PixelMatch match = expect_match(set, thousands, pixel_match_frames(480, 270)[0]);
      // Otherwise mostly edges would be compared.
      EXPECT_LT(match.near_edges, match.pixels / 100) << set << ' ' << thousands;
    }
  }
}

// The degenerate set has one to three quads per object to draw: all cameras are quick.
TEST(PixelMatch, MatchesFromEveryCamera) {
  for (const NamedFrame& view : pixel_match_frames(480, 270)) expect_match("degenerate", 4, view);
  expect_match("standard", 4, pixel_match_frames(160, 90).back());
}

// A voxel with sides of 1 m, 10 m away, seen along x: 10 x 10 pixels in a picture with a pixel width of 0.01 per metre
// of distance.
class OneVoxel : public testing::Test {
 protected:
  OneVoxel() : grid_(ivec3(1)) { grid_.set(ivec3(0), 1); }

  PictureFrame frame_ = [] {
    // 20 pixels high: tan(fov / 2) = 0.1.
    return frame_looking({-10, 0.5, 0.5}, {0, 0.5, 0.5}, {0, 0, 1}, 2 * std::atan(0.1), 20, 20);
  }();
  VoxelGrid grid_;
  std::vector<VoxelPlace> places_{VoxelPlace{}};
};

TEST_F(OneVoxel, CoversItsPixels) {
  const RasterPicture quads = rasterise(grid_, places_, frame_, kPixelMargin);
  EXPECT_TRUE(quads.near_edges.empty());
  for (int row = 0; row < 20; ++row) {
    for (int col = 0; col < 20; ++col) {
      const SeenFace& seen = quads.seen[static_cast<std::size_t>(row * 20 + col)];
      const bool inside = row >= 5 && row < 15 && col >= 5 && col < 15;
      ASSERT_EQ(std::isfinite(seen.t), inside) << row << ' ' << col;
      if (!inside) continue;
      EXPECT_EQ(seen.face, (FaceOf{0, ivec3(0), VoxelFace::low_x}));
      EXPECT_DOUBLE_EQ(seen.t, 10);
    }
  }
}

// Moves the eye until the left edge is within half a margin of the pixel centres of a column.
TEST_F(OneVoxel, FlagsPixelsNearEdges) {
  const double metres_per_pixel = 0.1;
  frame_.eye -= (0.5 + 0.5 * kPixelMargin) * metres_per_pixel * frame_.right;
  const RasterPicture quads = rasterise(grid_, places_, frame_, kPixelMargin);
  // Both sides of the front face; the eye does not see the others.
  EXPECT_EQ(quads.near_edges.size(), 20U);
  for (const NearEdge& near : quads.near_edges) EXPECT_EQ(near.face.face, VoxelFace::low_x);
}

// Errors that are invisible to the eye: rays that hit the neighbour of the right voxel, or nothing.
TEST(PixelMatch, DetectsMissingVoxels) {
  VoxelGrid grid = voxel_object("standard");
  const std::vector<VoxelPlace> places = object_places(1);
  const PictureFrame frame = pixel_match_frames(160, 90)[0].frame;
  const RasterPicture quads = rasterise(grid, places, frame, kPixelMargin);
  for (int y = 0; y < 32; ++y) grid.clear(ivec3(3, y, 12));
  EXPECT_GT(compare_with_quads(quads, hits_of(scene_of(grid, places), frame), grid, 0.25, frame).differ, 0);
}

TEST(PixelMatch, RejectsCamerasThatAreTooClose) {
  VoxelGrid grid(ivec3(32));
  grid.fill(grid.box(), 1);
  const std::vector<VoxelPlace> places{VoxelPlace{}};
  const PictureFrame frame = frame_looking({-0.01, 3.3, 3.3}, {0, 3.3, 3.3}, {0, 0, 1}, 0.8, 1080, 1080);
  const RasterPicture quads = rasterise(grid, places, frame, kPixelMargin);
  EXPECT_THROW(compare_with_quads(quads, hits_of(scene_of(grid, places), frame), grid, 1, frame), Error);
}

}  // namespace
}  // namespace scarp::bench
