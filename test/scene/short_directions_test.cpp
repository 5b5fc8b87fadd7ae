// SPDX-License-Identifier: MIT
// Directions near the limits of doubles: t is finite or the ray misses, in every kind of field, single and in batches.
#include <gtest/gtest.h>

#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "scarp/march/function/function_table.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/shape/shape_table.h"
#include "scarp/scarp.h"
#include "scarp/scene/tiled_terrain.h"

namespace scarp::test {
namespace {

struct Named {
  std::string name;
  Scene scene;
};

std::vector<Named> scenes() {
  std::vector<Named> all;
  const HeightField flat = HeightField::own(std::vector<float>(17 * 17, 2.0f), 17, 17);
  for (const HeightMarchEntry& march : height_marches())
    all.push_back({"heights, " + std::string(march.name), Scene(scene_heights(flat, march))});
  const HeightFunction plane(make_function(Sines{{{.amplitude = 0.5, .wavelength = 300}}}));
  for (const FunctionMarchEntry& march : function_marches())
    all.push_back({"function, " + std::string(march.name), Scene(scene_function(plane, march))});
  const DistanceField ball(make_shape(shape::Sphere{3}));
  for (const ShapeMarchEntry& march : shape_marches())
    all.push_back({"shape, " + std::string(march.name), combine({{scene_shape(ball, march), {.origin = {8, 8, 0}}}})});
  VoxelGrid grid({16, 16, 4});
  for (int x = 0; x < 16; ++x)
    for (int y = 0; y < 16; ++y) grid.set({x, y, 0}, 1);
  all.push_back({"voxels", Scene(Voxels(std::move(grid)))});
  TiledTerrain tiles({1, 1, 16, 16, {}});
  tiles.edit([&](auto& editor) { editor.put({0, 0}, flat); });
  all.push_back({"tiles", tiles.read()});
  all.push_back({"placed", combine({{Terrain(flat), {.scale = 2, .origin = {0, 0, 1}}},
                                    {scene_shape(ball), {.origin = {90, 90, 0}}}})});
  return all;
}

TEST(ShortDirections, HaveAFiniteTOrMiss) {
  for (const auto& [name, scene] : scenes()) {
    SCOPED_TRACE(name);
    const Ray usual{.origin = {7, 7.5, 40}, .direction = {0.03125, 0.015625, -1}, .t_max = 1e3};
    const Hit expected = scene.closest_hit(usual);
    ASSERT_TRUE(expected);
    // The direction is exact in all of these; the last ones are too short for the t of the hit.
    for (const int exponent : {0, -100, 100, -400, 400, -600, 600, 1000, -1010, -1020, -1040}) {
      SCOPED_TRACE(exponent);
      Ray ray = usual;
      for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = std::ldexp(usual.direction[axis], exponent);
      ray.t_max = std::ldexp(usual.t_max, -exponent);
      const double t = std::ldexp(expected.t, -exponent);
      std::vector<Ray> rays(64, ray);
      std::vector<Hit> hits(rays.size());
      scene.closest_hits(rays, hits);
      std::vector<std::uint8_t> blocked(rays.size());
      scene.occluded(rays, blocked);
      hits.push_back(scene.closest_hit(ray));
      blocked.push_back(scene.occluded(ray));
      for (const Hit& hit : {hits.front(), hits.back()}) {
        ASSERT_EQ(static_cast<bool>(hit), std::isfinite(t)) << static_cast<int>(hit.status);
        if (hit) {
          EXPECT_NEAR(hit.t / t, 1, 1e-3);
        }
      }
      EXPECT_EQ(blocked.front(), std::isfinite(t));
      EXPECT_EQ(blocked.back(), std::isfinite(t));
    }
  }
}

}  // namespace
}  // namespace scarp::test
