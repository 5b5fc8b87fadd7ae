// SPDX-License-Identifier: MIT
// Scenes of many fields on a Vulkan device: what the CPU tells of rays a little higher and lower, the device tells of
// those between.
#include "scarp/scene/scene_vk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "scarp/base/error.h"
#include "vk/device_under_test.h"

namespace scarp::test {
namespace {

class ScenesOnDevice : public OnDevice {};

double between(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

// A tilted, scaled height field and a ring over the hills of a function.
Scene terrain_and_hills() {
  std::mt19937_64 random(3);
  std::vector<float> samples(33 * 33);
  for (float& sample : samples) sample = static_cast<float>(between(random, 0, 4));
  std::vector<SceneFieldPtr> fields{
      scene_heights(HeightField::own(std::move(samples), 33, 33)),
      scene_function(HeightFunction(make_function(Fractal{.wavelength = 200, .height = 20, .octaves = {4, 3, 5}}))),
      scene_shape(DistanceField(make_shape(shape::Torus{.radius = 20, .tube = 6})))};
  const double c = std::cos(0.3), s = std::sin(0.3);
  glm::dmat3 tilt(1.0);
  tilt[0] = dvec3(c, 0, s), tilt[2] = dvec3(-s, 0, c);
  return Scene(std::move(fields), {{0, 0, {tilt, 3, {-40, -40, 30}}}, {1, 1, {}}, {2, 2, {tilt, 1, {60, 50, 30}}}});
}

TEST_F(ScenesOnDevice, TellTheNearestHit) {
  // Over these fields single precision is right to some millimetres: 4 times 2^-17 of twice 20 m, and 32 units of 200 m
  // in height and way for the height field; 4 times 48 of 100 m for the ring (doc/dev/numerics.md).
  constexpr double kDelta = 0.01;
  const Scene cpu = terrain_and_hills(), on_device = scene_on(device(), cpu);
  std::mt19937_64 random(4);
  std::vector<SceneRay> rays, higher, lower;
  for (int i = 0; i < 2000; ++i) {
    Ray ray;
    ray.origin = {between(random, -100, 100), between(random, -100, 100), between(random, 40, 90)};
    ray.direction = {between(random, -1, 1), between(random, -1, 1), between(random, -1, 0.1)};
    ray.t_max = 300;
    rays.push_back({ray});
    ray.origin.z += kDelta;
    higher.push_back({ray});
    ray.origin.z -= 2 * kDelta;
    lower.push_back({ray});
  }
  const auto closest = [](const Scene& scene, const std::vector<SceneRay>& of) {
    std::vector<SceneHit> hits(of.size());
    scene.closest_hits(of, hits);
    return hits;
  };
  const std::vector<SceneHit> above = closest(cpu, higher), below = closest(cpu, lower);
  std::vector<SceneHit> hits(rays.size());
  std::vector<std::uint32_t> steps(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  on_device.closest_hits(rays, hits, steps);
  on_device.occluded(rays, blocked);
  EXPECT_EQ(on_device.closest_hit(rays[0]).t(), hits[0].t());
  std::size_t agreed = 0, met[3] = {};
  std::vector<SceneRay> suns;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (above[i].field.status != below[i].field.status || above[i].object != below[i].object) continue;
    if (above[i] && std::abs(above[i].t() - below[i].t()) > 1) continue;
    ++agreed;
    ASSERT_EQ(hits[i].field.status, above[i].field.status) << i;
    if (!hits[i]) continue;
    ++met[hits[i].object];
    EXPECT_EQ(hits[i].object, above[i].object) << i;
    EXPECT_GT(steps[i], 0u);
    const double slack = 1e-5 * above[i].t();  // of lipschitz-local, on either side, and more
    EXPECT_GE(hits[i].t(), std::min(above[i].t(), below[i].t()) - slack) << i;
    EXPECT_LE(hits[i].t(), std::max(above[i].t(), below[i].t()) + slack) << i;
    Ray sun = rays[i].ray;
    sun.origin = sun.at(hits[i].t());
    sun.direction = {0.3, 0.2, 0.9};
    sun.t_max = 1e6;
    suns.push_back({sun, &hits[i]});
  }
  EXPECT_GT(agreed, rays.size() * 9 / 10);
  EXPECT_GT(met[0], 100u);
  EXPECT_GT(met[1], 500u);
  EXPECT_GT(met[2], 20u);
  // To the sun, from the surface: the function's shadow has another octave less, and begins on its own surface.
  std::vector<std::uint8_t> shaded(suns.size()), on_cpu(suns.size());
  on_device.occluded(suns, shaded);
  cpu.occluded(suns, on_cpu);
  std::size_t unlike = 0, dark = 0;
  for (std::size_t i = 0; i < suns.size(); ++i) unlike += shaded[i] != on_cpu[i], dark += on_cpu[i];
  EXPECT_LE(unlike, suns.size() / 200);
  EXPECT_GT(dark, 10u);
}

TEST_F(ScenesOnDevice, RefuseWhatDoesNotRunThere) {
  const auto model = std::make_shared<const VoxelModel>(VoxelGrid(ivec3(2), 8), find_voxel_march("voxel-bricks"));
  const VoxelPlace place{};
  const Scene scene({scene_shape(DistanceField(make_shape(shape::Sphere{}))),
                     scene_voxels(VoxelScene({model}, std::span(&place, 1)), "voxel-bricks")},
                    {{0, 0, {}}, {1, 0, {}}});
  try {
    scene_on(device(), scene);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(
        error.what(),
        "scene: field 1 (voxels): does not run on Vulkan devices; heights, functions and shapes do: ask the CPU");
  }
}

}  // namespace
}  // namespace scarp::test
