// SPDX-License-Identifier: MIT
// combine() of scarp.h: scenes of scenes.
#include "scarp/scene/combine.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/refusal.h"
#include "scarp/scarp.h"

namespace scarp {
namespace {

using test::refusal;

Terrain plain(float z) { return Terrain::own(std::vector<float>(4, z), 2, 2, {.cell_x = 10, .cell_y = 10}); }
SceneFieldPtr ball() { return scene_shape(DistanceField(make_shape(shape::Sphere{.radius = 1}))); }
// Length of the last interval of sphere-trace at t.
double bracket(double t) { return SphereTraceSettings{}.tolerance * t; }
Ray down(double x, double y) { return {.origin = {x, y, 100}, .direction = {0, 0, -1}}; }

TEST(Combine, KeepsTheOrderOfItsParts) {
  const Voxels cube(VoxelGrid({1, 1, 1}));
  VoxelGrid grid({2, 2, 2});
  grid.fill(grid.box(), 1);
  const Scene scene = combine({{plain(1)},
                               {Voxels(std::move(grid)), {.scale = 3, .origin = {20, 0, 0}}},
                               {ball(), {.origin = {5, 5, 9}}},
                               {cube}});
  ASSERT_EQ(scene.objects().size(), 4u);
  const Hit ground = cast(scene, down(1, 1)), voxel = cast(scene, down(21, 1)), top = cast(scene, down(5, 5));
  EXPECT_EQ(ground.object, 0u);
  EXPECT_EQ(ground.t, 99);
  EXPECT_EQ(voxel.object, 1u);
  EXPECT_EQ(voxel.t, 94);
  EXPECT_EQ(top.object, 2u);
  EXPECT_NEAR(top.t, 90, bracket(90));
}

TEST(Combine, SharesFields) {
  const Terrain terrain = plain(0);
  const SceneFieldPtr sphere = ball();
  const Scene scene = combine({{sphere}, {terrain}, {sphere, {.scale = 2}}, {terrain, {.origin = {50, 0, 0}}}});
  EXPECT_EQ(scene.fields().size(), 2u);
  EXPECT_EQ(scene.fields()[1], terrain.scene().fields()[0]);
}

TEST(Combine, PlacesNestedScenes) {
  const Scene pair = combine({{ball()}, {ball(), {.origin = {10, 0, 0}}, 7}});
  const Scene scene = combine({{pair, {.scale = 2, .origin = {0, 100, 0}}}, {pair, {.origin = {0, -100, 0}}, 3}});
  ASSERT_EQ(scene.objects().size(), 4u);
  EXPECT_EQ(scene.objects()[1].placement.origin, dvec3(20, 100, 0));
  EXPECT_EQ(scene.objects()[1].placement.scale, 2);
  EXPECT_EQ(scene.objects()[1].material, 7u);
  EXPECT_EQ(scene.objects()[3].material, 3u);
  EXPECT_NEAR(cast(scene, down(20, 100)).t, 98, bracket(98));
  EXPECT_EQ(cast(scene, down(10, -100)).object, 3u);
}

TEST(Combine, EmptySceneMissesEveryRay) { EXPECT_FALSE(cast(combine({}), down(0, 0))); }

TEST(Combine, RejectsBadPlacements) {
  EXPECT_EQ(refusal([] {
              combine({{plain(0)}, {ball(), {.scale = 0}}});
            }),
            "scene: object 1: its placement must be a rotation, a scale above 0, a finite place");
  EXPECT_EQ(refusal([] { combine({{SceneFieldPtr()}}); }), "scene: field 0 is null");
}

}  // namespace
}  // namespace scarp
