// SPDX-License-Identifier: MIT
// Scenes of many fields on a Vulkan device: the device's answers are between those of the CPU for slightly higher and
// lower rays.
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

TEST_F(ScenesOnDevice, FindTheNearestHit) {
  // Over these fields single precision is accurate to some millimetres: 4 times 2^-17 of twice 20 m, and 32 units of
  // 200 m in height and distance, for the height field; 4 times 48 units of 100 m for the ring (doc/dev/numerics.md).
  constexpr double kDelta = 0.01;
  const Scene cpu = terrain_and_hills(), on_device = scene_on(device(), cpu);
  std::mt19937_64 random(4);
  std::vector<Ray> rays, higher, lower;
  for (int i = 0; i < 2000; ++i) {
    Ray ray;
    ray.origin = {between(random, -100, 100), between(random, -100, 100), between(random, 40, 90)};
    ray.direction = {between(random, -1, 1), between(random, -1, 1), between(random, -1, 0.1)};
    ray.t_max = 300;
    rays.push_back(ray);
    ray.origin.z += kDelta;
    higher.push_back(ray);
    ray.origin.z -= 2 * kDelta;
    lower.push_back(ray);
  }
  const auto closest = [](const Scene& scene, const std::vector<Ray>& of) {
    std::vector<Hit> hits(of.size());
    scene.closest_hits(of, hits);
    return hits;
  };
  const std::vector<Hit> above = closest(cpu, higher), below = closest(cpu, lower);
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint32_t> steps(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  on_device.closest_hits(rays, hits, steps);
  on_device.occluded(rays, blocked);
  EXPECT_EQ(on_device.closest_hit(rays[0]).t, hits[0].t);
  std::size_t agreed = 0, met[3] = {};
  std::vector<Ray> suns;
  std::vector<const Hit*> from;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (above[i].status != below[i].status || above[i].object != below[i].object) continue;
    if (above[i] && std::abs(above[i].t - below[i].t) > 1) continue;
    ++agreed;
    ASSERT_EQ(hits[i].status, above[i].status) << i;
    if (!hits[i]) continue;
    ++met[hits[i].object];
    EXPECT_EQ(hits[i].object, above[i].object) << i;
    EXPECT_GT(steps[i], 0u);
    const double slack = 1e-5 * above[i].t;  // of lipschitz-local, on either side, and more
    EXPECT_GE(hits[i].t, std::min(above[i].t, below[i].t) - slack) << i;
    EXPECT_LE(hits[i].t, std::max(above[i].t, below[i].t) + slack) << i;
    Ray sun = rays[i];
    sun.origin = sun.at(hits[i].t);
    sun.direction = {0.3, 0.2, 0.9};
    sun.t_max = 1e6;
    suns.push_back(sun);
    from.push_back(&hits[i]);
  }
  EXPECT_GT(agreed, rays.size() * 9 / 10);
  EXPECT_GT(met[0], 100u);
  EXPECT_GT(met[1], 500u);
  EXPECT_GT(met[2], 20u);
  // To the sun, from the surface: the function's shadow has one octave fewer, and starts on its own surface.
  std::vector<std::uint8_t> shaded(suns.size()), on_cpu(suns.size());
  on_device.occluded(suns, shaded, from);
  cpu.occluded(suns, on_cpu, from);
  std::size_t unlike = 0, dark = 0;
  for (std::size_t i = 0; i < suns.size(); ++i) unlike += shaded[i] != on_cpu[i], dark += on_cpu[i];
  EXPECT_LE(unlike, suns.size() / 200);
  EXPECT_GT(dark, 10u);
}

TEST_F(ScenesOnDevice, RejectUnsupportedFields) {
  const auto model = std::make_shared<const VoxelModel>(VoxelGrid(ivec3(2), 8), find_voxel_march("voxel-bricks"));
  const Scene scene(scene_voxels({{model}, {VoxelPlace{}}, {.radius = 0.2}}));
  try {
    scene_on(device(), scene);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(
        error.what(),
        "scene: field 0 (voxels): does not run on Vulkan devices; heights, functions, shapes and voxels that are not "
        "rounded do: use the CPU");
  }
}

// Rounded voxels between a ball and a floor that the device answers.
TEST_F(ScenesOnDevice, UseTheCpuForOtherFields) {
  VoxelGrid grid(ivec3(4), 8);
  grid.edit(grid.box(), [](const ivec3& v, const VoxelGrid::Voxel&) {
    return (v.x + v.y + v.z) % 2 == 0 ? VoxelGrid::Voxel(1) : VoxelGrid::Voxel();
  });
  const auto model = std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-bricks"));
  const Scene cpu({scene_shape(DistanceField(make_shape(shape::Sphere{2}))),
                   scene_voxels({{model}, {VoxelPlace{}}, {.radius = 0.2}}),
                   scene_function(HeightFunction(make_function(Plane{})))},
                  {{0, 0, {.origin = {0, 0, 20}}}, {1, 0, {.scale = 2, .origin = {-4, -4, 4}}}, {2, 0, {}}});
  const Scene on_device = scene_on(device(), cpu);
  std::mt19937_64 random(5);
  std::vector<Ray> rays(2000);
  for (Ray& ray : rays) {
    ray.origin = {between(random, -6, 6), between(random, -6, 6), between(random, 14, 18)};
    ray.direction = {between(random, -0.3, 0.3), between(random, -0.3, 0.3), -1};
  }
  std::vector<Hit> hits(rays.size()), there(rays.size());
  cpu.closest_hits(rays, hits);
  on_device.closest_hits(rays, there);
  std::vector<Ray> on;
  std::vector<const Hit*> from;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(hits[i].object, there[i].object) << i;
    if (hits[i].object != 1) continue;
    EXPECT_EQ(hits[i], there[i]) << i;
    on.push_back(rays[i]);
    on.back().origin = rays[i].at(hits[i].t);
    on.back().direction = {0.3, 0.2, 0.9};
    from.push_back(&hits[i]);
  }
  EXPECT_GT(on.size(), 500u);
  std::vector<std::uint8_t> blocked(on.size()), blocked_there(on.size());
  cpu.occluded(on, blocked, from);
  on_device.occluded(on, blocked_there, from);
  EXPECT_EQ(blocked, blocked_there);
}

}  // namespace
}  // namespace scarp::test
