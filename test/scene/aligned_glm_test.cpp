// SPDX-License-Identifier: MIT
// Programs that define GLM_FORCE_DEFAULT_ALIGNED_GENTYPES (see this test's CMakeLists.txt), which gives glm::dvec3
// another layout than that of the compiled library.
#include <gtest/gtest.h>

#include <vector>

#include "scarp/render/camera/camera.h"
#include "scarp/scarp.h"
#include "scarp/scene/cast_from.h"
#include "scarp/scene/lidar.h"
#include "scarp/scene/live_scene.h"
#include "scarp/scene/scene_query.h"
#include "scarp/scene/tiled_terrain.h"

namespace scarp {
namespace {

// Otherwise GLM aligns nothing, and this tests nothing.
static_assert(alignof(glm::dvec3) > alignof(double) && sizeof(glm::dvec3) > sizeof(dvec3));
static_assert(sizeof(dvec3) == 3 * sizeof(double) && sizeof(dmat3) == 9 * sizeof(double));

TEST(AlignedGlm, VectorsOfTheProgramConvert) {
  const std::vector<float> heights(25, 3.0f);
  const Terrain terrain = Terrain::view(heights.data(), 5, 5);
  const glm::dvec3 eye(1.5, 2.25, 10), down(0, 0, -2);
  const Ray ray{.origin = dvec3(eye), .direction = dvec3(down)};
  const Hit hit = cast(terrain, ray);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.t, 3.5);
  const glm::dvec3 place(ray.at(hit.t));
  EXPECT_EQ(place.z, 3);
  const glm::dmat3 quarter(glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1));
  const Scene scene = combine({{terrain, {.turn = dmat3(quarter), .origin = dvec3(glm::dvec3(100, 0, 0))}}});
  EXPECT_TRUE(occluded(scene, {.origin = {98, 2, 10}, .direction = {0, 0, -1}}));
  EXPECT_EQ(scene
                .surface({.origin = {98, 2, 10}, .direction = {0, 0, -1}},
                         cast(scene, {.origin = {98, 2, 10}, .direction = {0, 0, -1}}))
                .position.z,
            3);
}

}  // namespace
}  // namespace scarp
