// SPDX-License-Identifier: MIT
// Voxels of scarp.h: volumes in memory, sizes, colours, edits, and errors.
#include "scarp/scene/voxels.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "base/refusal.h"
#include "scarp/scarp.h"

namespace scarp {
namespace {

using test::refusal;

const std::vector<VoxelColour> kPalette{{}, {255, 0, 0}, {0, 255, 0}};

// 3 x 2 x 4 voxels: index 1 at (2, 1, 0), 2 at (0, 1, 3).
std::vector<std::uint8_t> volume() {
  std::vector<std::uint8_t> indices(24, 0);
  indices[2 + 3 * 1] = 1;
  indices[0 + 3 * (1 + 2 * 3)] = 2;
  return indices;
}

TEST(Voxels, CopiesAVolumeXFastest) {
  std::vector<std::uint8_t> indices = volume();
  const Voxels voxels = Voxels::copy(indices.data(), {3, 2, 4}, {.palette = kPalette});
  indices.assign(indices.size(), 1);
  EXPECT_EQ(voxels.grid().solid_count(), 2);
  const Hit red = cast(voxels, {.origin = {2.5, 1.5, 10}, .direction = {0, 0, -1}});
  ASSERT_TRUE(red);
  EXPECT_EQ(red.t, 9);
  EXPECT_EQ(red.voxel, ivec3(2, 1, 0));
  EXPECT_EQ(red.face, VoxelFace::high_z);
  EXPECT_EQ(voxels.colour(red), kPalette[1]);
  const Hit green = cast(voxels, {.origin = {-5, 1.5, 3.5}, .direction = {1, 0, 0}});
  ASSERT_TRUE(green);
  EXPECT_EQ(green.t, 5);
  EXPECT_EQ(voxels.colour(green), kPalette[2]);
  EXPECT_FALSE(occluded(voxels, {.origin = {0.5, 0.5, 10}, .direction = {0, 0, -1}}));
}

TEST(Voxels, HaveASideInMetres) {
  const Voxels voxels = Voxels::copy(volume().data(), {3, 2, 4}, {.side = 0.5});
  const Hit hit = cast(voxels, {.origin = {1.25, 0.75, 10}, .direction = {0, 0, -1}});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.t, 9.5);
  EXPECT_EQ(voxels.colour(hit), kPlainVoxels);
  EXPECT_EQ(voxels.scene().cell_side(), 0.5);
}

TEST(Voxels, UseRgbOfGridsWithoutAPalette) {
  VoxelGrid grid({2, 2, 2}, 24);
  grid.set({0, 0, 0}, 0x302010);
  const Voxels voxels(std::move(grid));
  const Hit hit = cast(voxels, {.origin = {0.5, 0.5, 10}, .direction = {0, 0, -1}});
  EXPECT_EQ(voxels.colour(hit), (VoxelColour{0x10, 0x20, 0x30}));
}

TEST(Voxels, MatchFreshVoxelsAfterEdits) {
  VoxelGrid grid({32, 32, 32});
  grid.fill_sphere({16, 16, 16}, 6, 1);
  Voxels voxels(grid);
  const Voxels copy = voxels;
  const auto change = [](VoxelGrid& g) {
    return around(g.clear_sphere({16, 16, 16}, 4), g.fill({{0, 0, 0}, {3, 32, 3}}, 2));
  };
  voxels.edit(change);
  change(grid);
  const Voxels fresh(grid);
  for (int i = 0; i < 32; ++i) {
    const Ray ray{.origin = {i + 0.5, -4, 1.5 + 0.9 * i}, .direction = {0.01 * i, 1, 0.02 * (16 - i)}};
    EXPECT_EQ(cast(voxels, ray), cast(fresh, ray)) << i;
    EXPECT_EQ(cast(copy, ray), cast(fresh, ray)) << i;
  }
  EXPECT_EQ(copy.scene().box().low, dvec3(0.0));
}

TEST(Voxels, EmptyGridMissesEveryRay) {
  const Voxels voxels(VoxelGrid({1, 1, 1}));
  EXPECT_EQ(cast(voxels, {.origin = {0.5, 0.5, 10}}).status, HitStatus::miss);
}

TEST(Voxels, RejectBadInput) {
  const std::vector<std::uint8_t> indices(8, 7);
  EXPECT_EQ(refusal([] { Voxels::copy(nullptr, {2, 2, 2}); }), "voxels: the pointer to the indices is null");
  EXPECT_EQ(refusal([&] {
              Voxels::copy(indices.data(), {2, 2, 2}, {.palette = kPalette});
            }),
            "voxels: the index at (0, 0, 0) is 7, but the palette has 3 colours");
  EXPECT_NE(refusal([&] { Voxels::copy(indices.data(), {0, 2, 2}); }), "");
  EXPECT_NE(refusal([&] { Voxels::copy(indices.data(), {2, 2, VoxelGrid::kMaxSide + 1}); }), "");
  EXPECT_EQ(refusal([] {
              Voxels(VoxelGrid({1, 1, 1}), {.side = 0});
            }),
            "voxels: side is 0 (must be finite and above 0)");
  EXPECT_NE(refusal([] { Voxels(VoxelGrid({1, 1, 1}), {.side = NAN}); }), "");
}

}  // namespace
}  // namespace scarp
