// SPDX-License-Identifier: MIT
// All marches on rays that enter below the ground: they continue, and hit where they later descend through it.
#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <vector>

#include "march/glsl_host.h"
#include "march/height/entering_rays.h"
#include "march/height/spiteful_text.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/march/height/device_ray.h"
#include "scarp/march/height/height_marches.glsl.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/sampling/device_sampling.h"

namespace scarp::test {
namespace {

class EnteringRays : public testing::TestWithParam<HeightMarchEntry> {};

std::vector<HeightMarchEntry> marches_that_go_on() {
  std::vector<HeightMarchEntry> marches(height_marches().begin(), height_marches().end());
  std::erase_if(marches, [](const HeightMarchEntry& march) { return !march.follows_below; });
  return marches;
}

TEST_P(EnteringRays, ContinueIntoTheField) {
  expect_entering_rays_go_on(GetParam(),
                             [](const HeightField& field, const std::vector<Ray>& rays, std::vector<Hit>& hits) {
                               const MaxPyramid pyramid(field);
                               const HeightTarget target{&field, &pyramid, slope_bound(field)};
                               GetParam().batch(target, rays, hits, {});
                               for (std::size_t i = 0; i < rays.size(); ++i) {
                                 EXPECT_EQ(hits[i], GetParam().cpu(target, rays[i], {}, nullptr));
                                 EXPECT_EQ(static_cast<bool>(hits[i]), GetParam().occluded(target, rays[i], {}));
                               }
                             });
}

INSTANTIATE_TEST_SUITE_P(Marches, EnteringRays, testing::ValuesIn(marches_that_go_on()),
                         [](const auto& of) { return test_name(std::string(of.param.name)); });

// The shader text, as C++.
TEST(EnteringRays, ContinueInSinglePrecision) {
  for (const std::string_view name : {"naive", "fixed-step", "relaxed", "lipschitz"}) {
    expect_entering_rays_go_on(
        find_height_march(name), [&](const HeightField& field, const std::vector<Ray>& rays, std::vector<Hit>& hits) {
          const MaxPyramid pyramid(field);
          glsl::host_field = &field;
          glsl::host_pyramid = &pyramid;
          const glsl::ScarpSampling settings =
              device_sampling(find_height_march(name).sampling, {}, slope_bound(field), 0, 1);
          for (std::size_t i = 0; i < rays.size(); ++i) {
            const DeviceRay prepared = sampled_device_ray(field, rays[i]);
            hits[i] = hit_from_device(rays[i], prepared,
                                      glsl::scarp_sampled(device_field(field, &pyramid), prepared.ray, settings));
          }
        });
  }
}

// A tolerance that grows with the distance does not hide where the ray leaves the ground.
TEST(EnteringRays, ContinueFromFarAway) {
  const HeightField field = bowl_field(false, false);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid, slope_bound(field)};
  Ray ray{{-1e6, 20, 10}, {1, 0, 0}};
  const Hit judge = march_exhaustive(target, ray);
  ASSERT_TRUE(judge);
  MarchSettings settings;
  settings.naive.min_step = 1e-7;  // of a million metres
  for (const HeightMarchEntry& march : marches_that_go_on()) {
    const Hit hit = march.cpu(target, ray, settings, nullptr);
    EXPECT_TRUE(hit) << march.name;
    EXPECT_GT(hit.t, 1e6 + 10) << march.name;
    EXPECT_LT(hit.t, judge.t + 1) << march.name;
  }
}

// A ray that starts below the ground of the field has the documented answer of the march.
TEST(EnteringRays, KeepDocumentedAnswersWhenStartingBelowGround) {
  const HeightField field = bowl_field(false, false);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid, slope_bound(field)};
  const Ray ray{{2, 20, 10}, {1, 0, 0}};
  for (const HeightMarchEntry& march : height_marches()) {
    const Hit hit = march.cpu(target, ray, {}, nullptr);
    if (march.name == "naive") {
      EXPECT_EQ(hit.t, 0);
    } else if (march.name == "relaxed" || march.name == "lipschitz" || !march.follows_below) {
      EXPECT_EQ(hit.status, HitStatus::below) << march.name;
    } else {
      EXPECT_NEAR(hit.t, march_exhaustive(target, ray).t, 0.5) << march.name;
    }
  }
}

}  // namespace
}  // namespace scarp::test
