// SPDX-License-Identifier: MIT
#include "scarp/scene/plinth.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace scarp {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Ray ray_of(dvec3 origin, dvec3 direction) {
  Ray ray;
  ray.origin = origin;
  ray.direction = direction;
  return ray;
}

// 4 x 3 nodes, 10 m apart: x 0..30, y 0..20, all at 5 m except for a south-east corner at 9 m.
HeightField block() {
  return HeightField::own<float>({5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 9}, 4, 3, {.cell_x = 10, .cell_y = 10});
}

TEST(Plinth, WallsStandAtTheBorder) {
  const Plinth plinth(block(), 0);
  const struct {
    dvec3 origin, direction;
    VoxelFace face;
    double t;
  } cases[] = {{{12, -40, 2}, {0, 1, 0}, VoxelFace::low_y, 40},
               {{12, 60, 2}, {0, -2, 0}, VoxelFace::high_y, 20},
               {{-3, 7, 2}, {1, 0, 0}, VoxelFace::low_x, 3},
               {{50, 7, 2}, {-1, 0, 0}, VoxelFace::high_x, 20}};
  for (const auto& c : cases) {
    const auto wall = plinth.intersect(ray_of(c.origin, c.direction));
    ASSERT_TRUE(wall);
    EXPECT_DOUBLE_EQ(wall->t, c.t);
    EXPECT_EQ(wall->face, c.face);
  }
}

TEST(Plinth, WallsReachFromBaseToSurface) {
  const Plinth plinth(block(), 1);
  const auto meets = [&](double x, double z) { return plinth.intersect(ray_of({x, -1, z}, {0, 1, 0})).has_value(); };
  EXPECT_TRUE(meets(5, 1.001));
  EXPECT_TRUE(meets(5, 4.999));
  EXPECT_FALSE(meets(5, 5.001));
  EXPECT_FALSE(meets(5, 0.999));
  // The last edge of the south border rises from 5 to 9 m.
  EXPECT_TRUE(meets(25, 6.999));
  EXPECT_FALSE(meets(25, 7.001));
}

TEST(Plinth, EveryWallFollowsItsOwnEdge) {
  // One cell, 0..1 m, with four different corners: north-west 10, north-east 20, south-west 30, south-east 40.
  const Plinth plinth(HeightField::own<float>({10, 20, 30, 40}, 2, 2), 0);
  const struct {
    dvec3 origin, direction;
    double edge;  // height of the wall where the ray hits, a quarter of the way along it
  } cases[] = {{{0.25, -1, 0}, {0, 1, 0}, 32.5},
               {{0.25, 2, 0}, {0, -1, 0}, 12.5},
               {{-1, 0.25, 0}, {1, 0, 0}, 25},
               {{2, 0.25, 0}, {-1, 0, 0}, 35}};
  for (const auto& c : cases) {
    EXPECT_TRUE(plinth.intersect(ray_of(c.origin + dvec3(0, 0, c.edge - 0.01), c.direction))) << c.edge;
    EXPECT_FALSE(plinth.intersect(ray_of(c.origin + dvec3(0, 0, c.edge + 0.01), c.direction))) << c.edge;
  }
}

TEST(Plinth, HeightsAreExaggeratedMetres) {
  const HeightField field =
      HeightField::own<std::int16_t>({10, 10, 10, 10}, 2, 2, {.scale = 0.5, .offset = 100, .exaggeration = 2});
  const Plinth plinth(field, 150);
  EXPECT_TRUE(plinth.intersect(ray_of({0.5, -1, 209}, {0, 1, 0})));
  EXPECT_FALSE(plinth.intersect(ray_of({0.5, -1, 211}, {0, 1, 0})));
  EXPECT_TRUE(plinth.intersect(ray_of({0.5, -1, 151}, {0, 1, 0})));
  EXPECT_FALSE(plinth.intersect(ray_of({0.5, -1, 149}, {0, 1, 0})));
}

TEST(Plinth, RaysFromAboveOrInsideHitNoWall) {
  const Plinth plinth(block(), 0);
  EXPECT_FALSE(plinth.intersect(ray_of({12, 7, 50}, {0.1, 0.1, -1})));
  EXPECT_FALSE(plinth.intersect(ray_of({12, 7, 2}, {1, 0.2, 0})));
  EXPECT_FALSE(plinth.intersect(ray_of({12, -40, 2}, {0, -1, 0})));
}

TEST(Plinth, HolesHaveWallsToo) {
  // 7 x 3 nodes at 5 m, 1 m apart; the node at column 3 is nodata, so the cells of columns 2 and 3 are holes: x 2..4.
  std::vector<float> samples(21, 5.0f);
  samples[3] = samples[10] = samples[17] = kNaN;
  const Plinth plinth(HeightField::own(samples, 7, 3), 0);
  // Down through the hole, eastwards: to the wall at x = 4.
  const auto wall = plinth.intersect(ray_of({2.5, 1.3, 6}, {1, 0, -2}));
  ASSERT_TRUE(wall);
  EXPECT_DOUBLE_EQ(wall->t, 1.5);
  EXPECT_EQ(wall->face, VoxelFace::low_x);
  // Westwards: to the wall at x = 2.
  const auto west = plinth.intersect(ray_of({3.5, 1.3, 6}, {-1, 0, -2}));
  ASSERT_TRUE(west);
  EXPECT_DOUBLE_EQ(west->t, 1.5);
  EXPECT_EQ(west->face, VoxelFace::high_x);
  // Steeply: through the hole and out through the bottom.
  EXPECT_FALSE(plinth.intersect(ray_of({3, 1.3, 6}, {0.1, 0, -2})));
  // A ray through the surface has hit the surface and not the hole's wall behind it.
  EXPECT_FALSE(plinth.intersect(ray_of({0.2, 1.3, 5.5}, {1, 0, -1})));
}

TEST(Plinth, RaysFromSolidGroundHitNoWall) {
  // A valley of 1 m between plateaus of 5 m: 9 x 2 nodes, of which that of column 4 is nodata, so x 3..5 is a hole.
  std::vector<float> samples;
  for (int row = 0; row < 2; ++row) {
    for (int col = 0; col < 9; ++col) samples.push_back(col == 4 ? kNaN : col < 2 ? 5 : col < 6 ? 1 : 5);
  }
  const Plinth plinth(HeightField::own(samples, 9, 2), 0);
  // The ray leaves the slope between columns 1 and 2 in its first cell, and passes over the hole into the block behind
  // it.
  EXPECT_FALSE(plinth.intersect(ray_of({1.5, 0.3, 2.9}, {1, 0, -0.7})));
  EXPECT_TRUE(plinth.intersect(ray_of({1.5, 0.3, 3.1}, {1, 0, -0.7})));
  // Rays go up through the base: in the rock, or in the shaft of the hole.
  EXPECT_FALSE(plinth.intersect(ray_of({1.5, 0.3, -0.1}, {1, 0, 0.2})));
  EXPECT_TRUE(plinth.intersect(ray_of({3.2, 0.3, -0.1}, {1, 0, 0.2})));
}

TEST(Plinth, BaseLiesBelowTheField) {
  EXPECT_LT(plinth_base(block()), 5);
  const HeightField flat = HeightField::own<float>({5, 5, 5, 5}, 2, 2);
  EXPECT_LT(plinth_base(flat), 5);
}

}  // namespace
}  // namespace scarp
