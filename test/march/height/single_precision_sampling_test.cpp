// SPDX-License-Identifier: MIT
// The shader text of the marches that take samples, compiled as C++ with floats: they do what their texts say.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cases.h"
#include "march/glsl_host.h"
#include "march/height/rounding_judge.h"
#include "march/height/spiteful.h"
#include "march/height/spiteful_text.h"
#include "march/sampling_rules.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/march/device_sampling.h"
#include "scarp/march/height/device_ray.h"
#include "scarp/march/height/height_marches.glsl.h"

namespace scarp::test {
namespace {

constexpr int kFieldsPerPair = 2;
const int kRaysPerField = cases(40, 10, 4);

struct Marched {
  std::string_view march;
  MarchSettings settings;
};

class SinglePrecisionSampling : public testing::TestWithParam<std::string> {};

TEST_P(SinglePrecisionSampling, KeepsItsRule) {
  Marched marched{GetParam(), {}};
  if (marched.march == "fixed-step, plain") {
    marched.march = "fixed-step";
    marched.settings.fixed_step.interpolate = false;
  }
  int hits = 0;
  for (const Pair& pair : pairs()) {
    const FieldKind& fields = spiteful_fields()[pair.field];
    const RayKind& rays = spiteful_rays()[pair.ray];
    Random random(1000 * pair.field + pair.ray);
    for (int i = 0; i < kFieldsPerPair; ++i) {
      const HeightField field = fields.make(random);
      const MaxPyramid pyramid(field);
      const double slope = slope_bound(field);
      glsl::host_field = &field;
      glsl::host_pyramid = &pyramid;
      for (int j = 0; j < kRaysPerField; ++j) {
        const Ray ray = rays.make(field, random);
        const DeviceRay prepared = sampled_device_ray(field, ray);
        glsl::ScarpHit answer{};
        if (prepared.marches)
          answer = glsl::scarp_sampled(device_field(field, &pyramid), prepared.ray,
                                       device_sampling(marched.march, marched.settings, slope, 0, 1));
        const Hit hit = hit_from_device(ray, prepared, answer);
        hits += static_cast<bool>(hit);
        const std::string objection =
            sampling_objection(marched.march, marched.settings, field, slope, ray, RoundingJudge(field, ray), hit);
        ASSERT_EQ(objection, "") << fields.name << ", " << rays.name << ": " << text(ray) << "\n  " << text(hit);
      }
    }
  }
  EXPECT_GT(hits, 100 * kRaysPerField);
}

INSTANTIATE_TEST_SUITE_P(Marches, SinglePrecisionSampling,
                         testing::Values("naive", "relaxed", "lipschitz", "fixed-step", "fixed-step, plain"),
                         [](const auto& of) { return test_name(of.param); });

// `lipschitz` over holes: else it would take another step in a block that it has left.
TEST(SinglePrecisionSampling, LeavesBlocks) {
  constexpr int kSide = 129, kRays = 4000;
  const HeightField field = HeightField::own(std::vector<float>(kSide * kSide, 0.0F), kSide, kSide);
  const MaxPyramid pyramid(field);
  glsl::host_field = &field;
  glsl::host_pyramid = &pyramid;
  const glsl::ScarpField on_device = device_field(field, &pyramid);
  Random random(11);
  int left = 0;
  for (int i = 0; i < kRays; ++i) {
    Ray ray;
    ray.origin = {uniform(random, 0, kSide - 1), uniform(random, 0, kSide - 1), 1};
    // Some nearly along an axis: the slower a line is crossed, the more its time rounds.
    ray.direction = {uniform(random, -1, 1), uniform(random, -1, 1) * std::exp2(-uniform(random, 0, 12)), -0.001};
    const DeviceRay prepared = sampled_device_ray(field, ray);
    ASSERT_TRUE(prepared.marches);
    const float s = static_cast<float>(uniform(random, 0, 1)) * prepared.ray.exit;
    const int level = whole(random, 0, pyramid.top_level());
    const glsl::ScarpPoint from = glsl::scarp_point(on_device, prepared.ray, s);
    const float after = glsl::scarp_leave_time(on_device, prepared.ray, from, level, s);
    if (after > prepared.ray.exit) continue;
    ++left;
    const glsl::ScarpPoint to = glsl::scarp_point(on_device, prepared.ray, after);
    EXPECT_TRUE(to.cell.x >> level != from.cell.x >> level || to.cell.y >> level != from.cell.y >> level) << text(ray);
  }
  EXPECT_GT(left, kRays / 4);
}

}  // namespace
}  // namespace scarp::test
