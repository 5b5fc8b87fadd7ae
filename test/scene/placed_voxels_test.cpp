// SPDX-License-Identifier: MIT
// The march of models from files.
#include "scarp/scene/voxel/placed_voxels.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/refusal.h"

namespace scarp {
namespace {

TEST(PlacedVoxels, UseOctantsForSmallModels) {
  const auto usual = [](const std::vector<ivec3>& sizes) { return file_voxel_march({}, sizes).name; };
  EXPECT_EQ(usual({}), "voxel-octants");
  EXPECT_EQ(usual({{128, 128, 64}}), "voxel-octants");
  EXPECT_EQ(usual({{128, 128, 64}, {1, 1, 1}}), "voxel-bricks");
  EXPECT_EQ(usual({{2048, 2048, 2048}}), "voxel-bricks");
  EXPECT_EQ(usual({{512, 1, 1}}), "voxel-octants");
  EXPECT_EQ(usual({{513, 1, 1}}), "voxel-bricks");
  // This limit is the march's own.
  VoxelGrid grid({513, 1, 1}, 8);
  grid.fill(grid.box(), 1);
  EXPECT_NE(test::refusal([&] { VoxelModel(grid, find_voxel_march("voxel-octants")); }), "");
}

TEST(PlacedVoxels, UseTheNamedMarch) {
  const std::vector<ivec3> sizes{{8, 8, 8}};
  EXPECT_EQ(file_voxel_march("voxel-cubes", sizes).name, "voxel-cubes");
  EXPECT_NE(test::refusal([&] { file_voxel_march("voxel-balls", sizes); }), "");
}

}  // namespace
}  // namespace scarp
