// SPDX-License-Identifier: MIT
// The sampling marches on a Vulkan device, compared with their text as C++: they sample the same points, also along
// rays that are clipped at the highest sample.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "march/glsl_host.h"
#include "march/height/spiteful.h"
#include "march/height/spiteful_text.h"
#include "scarp/accel/device_ground.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/march/height/device_ray.h"
#include "scarp/march/height/height_marches_lean.glsl.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/height/queries_vk.h"
#include "scarp/march/sampling/device_sampling.h"
#include "vk/device_under_test.h"

namespace scarp::test {
namespace {

constexpr int kHillsSide = 257;
constexpr std::size_t kRaysAlongHills = 2000;

class HeightMarchesOnDevice : public OnDevice, public testing::WithParamInterface<std::string> {};

std::vector<Ray> rays_along(const HeightField& hilly) {
  Random random(4);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < kRaysAlongHills; ++i) rays.push_back(along_hills(hilly, random, i % 2 == 0));
  return rays;
}

// Both passes of a device.
glsl::ScarpHit march_text(const glsl::ScarpField& field, const glsl::ScarpRay& ray,
                          const glsl::ScarpSampling& settings) {
  glsl::ScarpHit hit = glsl::scarp_no_hit();
  glsl::ScarpStretch at = glsl::scarp_stretch_begin(field, ray, settings);
  while (!glsl::scarp_stretch_on(field, ray, settings, false, at, hit)) {
  }
  return hit.status == glsl::kScarpDoubtful ? glsl::scarp_sampled(field, ray, settings) : hit;
}

TEST_P(HeightMarchesOnDevice, SampleTheSamePointsAsTheCpu) {
  const HeightField field = test::hills(kHillsSide, kHillsSide, Surface::bilinear);
  const MaxPyramid pyramid(field);
  glsl::host_field = &field;
  glsl::host_pyramid = &pyramid;
  const std::vector<Ray> rays = rays_along(field);
  const DeviceGround ground(device(), field);
  const DeviceTarget target{&field, &ground, slope_bound(field)};
  const glsl::ScarpSampling settings = device_sampling(find_height_march(GetParam()).sampling, {}, target.slope, 0, 1);
  DeviceQueries queries(device(), find_height_march(GetParam()), {}, {.statistics = true});
  std::vector<Hit> hits(kRaysAlongHills);
  std::vector<DeviceRayCost> costs(kRaysAlongHills);
  std::vector<std::uint8_t> blocked(kRaysAlongHills);
  queries.closest_hits(target, rays, hits, costs);
  queries.occluded(target, rays, blocked);
  int met = 0, others = 0;
  for (std::size_t i = 0; i < kRaysAlongHills; ++i) {
    const DeviceRay prepared = sampled_device_ray(field, rays[i]);
    if (!prepared.marches) continue;
    glsl::ScarpField on_device = device_field(field, &pyramid);
    on_device.flags |= glsl::kScarpStarts;
    const glsl::ScarpHit expected = march_text(on_device, prepared.ray, settings);
    const Hit hit = hit_from_device(rays[i], prepared, expected);
    EXPECT_EQ(blocked[i], static_cast<bool>(hits[i]));
    met += static_cast<bool>(hits[i]);
    // Rounding on the device may lead a ray to other points.
    others += hits[i].status != hit.status || costs[i].steps != expected.steps;
  }
  EXPECT_GT(met, kRaysAlongHills / 4);
  EXPECT_LE(others, kRaysAlongHills / 200);
}

// Above the highest sample there is nothing to hit.
TEST_P(HeightMarchesOnDevice, StopAboveTheHighestSampleOnRequest) {
  const HeightField field = test::hills(kHillsSide, kHillsSide, Surface::bilinear);
  std::vector<Ray> rays = rays_along(field);
  for (Ray& ray : rays) ray.direction.z = std::abs(ray.direction.z) + 0.4;
  // From above the highest sample: level and up.
  rays[0].start = rays[1].start = RayStart::free;
  rays[0].origin.z = rays[1].origin.z = field.max_sample() + 0.5;
  rays[0].direction.z = 0;
  const DeviceGround ground(device(), field);
  const DeviceTarget target{&field, &ground, slope_bound(field)};
  const HeightMarchEntry& march = find_height_march(GetParam());
  DeviceQueries whole(device(), march, {}, {.statistics = true});
  DeviceQueries clipped(device(), march, {}, {.statistics = true, .clip_at_top = true});
  std::vector<Hit> hits(kRaysAlongHills), clipped_hits(kRaysAlongHills);
  std::vector<DeviceRayCost> costs(kRaysAlongHills), clipped_costs(kRaysAlongHills);
  whole.closest_hits(target, rays, hits, costs);
  clipped.closest_hits(target, rays, clipped_hits, clipped_costs);
  std::uint64_t steps = 0, clipped_steps = 0;
  int met = 0;
  for (std::size_t i = 0; i < kRaysAlongHills; ++i) {
    steps += costs[i].steps;
    clipped_steps += clipped_costs[i].steps;
    EXPECT_LE(clipped_costs[i].steps, costs[i].steps);
    if (hits[i] && hits[i].height > field.max_sample()) {
      EXPECT_FALSE(clipped_hits[i]);
      continue;
    }
    EXPECT_EQ(clipped_hits[i].status, hits[i].status);
    if (!hits[i]) continue;
    ++met;
    // Rounding at the border has the same effect as a slightly different end.
    EXPECT_NEAR(clipped_hits[i].t, hits[i].t, 1e-3);
  }
  EXPECT_EQ(clipped_costs[0].steps, 0u);
  EXPECT_EQ(clipped_costs[1].steps, 0u);
  EXPECT_GT(met, kRaysAlongHills / 20);
  EXPECT_LT(clipped_steps, steps * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(Marches, HeightMarchesOnDevice, testing::Values("naive", "fixed-step", "relaxed", "lipschitz"),
                         [](const auto& of) { return test_name(of.param); });

}  // namespace
}  // namespace scarp::test
