// SPDX-License-Identifier: MIT
// The shader text of the sampling marches, compiled as C++ with floats: they follow their documentation.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cases.h"
#include "march/glsl_host.h"
#include "march/height/rounding_judge.h"
#include "march/height/sampled_twin.h"
#include "march/height/spiteful.h"
#include "march/height/spiteful_text.h"
#include "march/sampling_rules.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/march/height/device_ray.h"
#include "scarp/march/height/float_ray.glsl.h"
#include "scarp/march/height/height_marches_lean.glsl.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/sampling/device_sampling.h"

namespace scarp::test {
namespace {

constexpr int kFieldsPerPair = 2;
const int kRaysPerField = cases(40, 10, 4);

struct Marched {
  std::string_view march;
  MarchSettings settings;
};

// The answer of the first pass; its status may be kScarpDoubtful.
glsl::ScarpHit lean(const glsl::ScarpField& field, const glsl::ScarpRay& ray, const glsl::ScarpSampling& settings,
                    bool any) {
  glsl::ScarpHit hit = glsl::scarp_no_hit();
  glsl::ScarpStretch at = glsl::scarp_stretch_begin(field, ray, settings);
  while (!glsl::scarp_stretch_on(field, ray, settings, any, at, hit)) {
  }
  return hit;
}

struct Counts {
  int hits = 0, asked = 0, doubtful = 0;
};

// Casts rays of a kind over a field of a kind, by both passes.
void check(const Marched& marched, const FieldKind& fields, const RayKind& rays, Random& random, Counts& counts) {
  const HeightField field = fields.make(random);
  const MaxPyramid pyramid(field);
  const double slope = slope_bound(field);
  glsl::host_field = &field;
  glsl::host_pyramid = &pyramid;
  const glsl::ScarpSampling settings =
      device_sampling(find_height_march(marched.march).sampling, marched.settings, slope, 0, 1);
  for (int j = 0; j < kRaysPerField; ++j) {
    const Ray ray = rays.make(field, random);
    const DeviceRay prepared = sampled_device_ray(field, ray);
    if (!prepared.marches) continue;
    glsl::ScarpField on_device = device_field(field, &pyramid);
    on_device.flags |= glsl::kScarpStarts;
    const RoundingJudge judge(field, ray);
    const auto check_answer = [&](const char* pass, const glsl::ScarpHit& answer) {
      const Hit hit = hit_from_device(ray, prepared, answer);
      const std::string objection = sampling_objection(marched.march, marched.settings, field, slope, ray, judge, hit);
      ASSERT_EQ(objection, "") << pass << " pass, " << fields.name << ", " << rays.name << ": " << text(ray) << "\n  "
                               << text(hit);
      counts.hits += static_cast<bool>(hit);
    };
    ++counts.asked;
    check_answer("second", glsl::scarp_sampled(on_device, prepared.ray, settings));
    const glsl::ScarpHit first = lean(on_device, prepared.ray, settings, false);
    ASSERT_EQ(lean(on_device, prepared.ray, settings, true).status, first.status);
    if (first.status == glsl::kScarpDoubtful)
      ++counts.doubtful;
    else
      check_answer("first", first);
  }
}

Marched marched_as(std::string_view name) {
  Marched marched{name, {}};
  if (name == "fixed-step, plain") {
    marched.march = "fixed-step";
    marched.settings.fixed_step.interpolate = false;
  }
  return marched;
}

class SinglePrecisionSampling : public testing::TestWithParam<std::string> {};

TEST_P(SinglePrecisionSampling, FollowsItsStepRule) {
  Counts counts;
  for (const Pair& pair : pairs()) {
    Random random(1000 * pair.field + pair.ray);
    for (int i = 0; i < kFieldsPerPair; ++i)
      check(marched_as(GetParam()), spiteful_fields()[pair.field], spiteful_rays()[pair.ray], random, counts);
  }
  EXPECT_GT(counts.hits, 100 * kRaysPerField);
  // Rays that start or enter below the ground.
  EXPECT_LT(counts.doubtful, counts.asked / 2);
}

// Over several stretches.
TEST_P(SinglePrecisionSampling, FollowsItsStepRuleOnLongRays) {
  Counts counts;
  Random random(7);
  for (const FieldKind& fields : wide_fields()) {
    for (const RayKind& rays : rays_across_tiles()) {
      for (int i = 0; i < kFieldsPerPair; ++i) check(marched_as(GetParam()), fields, rays, random, counts);
    }
  }
  EXPECT_GT(counts.hits, 10 * kRaysPerField);
  EXPECT_LT(counts.doubtful, counts.asked / 2);
}

INSTANTIATE_TEST_SUITE_P(Marches, SinglePrecisionSampling,
                         testing::Values("naive", "relaxed", "lipschitz", "fixed-step", "fixed-step, plain"),
                         [](const auto& of) { return test_name(of.param); });

// Rays that a shader makes are those of `cast`: the marches look at the same points.
TEST(SinglePrecisionSampling, RaysOfShadersStartAsRaysOfCast) {
  constexpr int kRays = 3000;
  const HeightField field = Twins::hills();
  const MaxPyramid pyramid(field);
  const double slope = slope_bound(field);
  glsl::host_field = &field;
  glsl::host_pyramid = &pyramid;
  const glsl::ScarpField ground = device_field(field, &pyramid);
  for (const std::string_view march : Twins::kMarches) {
    Twins twins({&field, &pyramid, slope});
    const glsl::ScarpSampling settings = device_sampling(find_height_march(march).sampling, {}, slope, 0, 1);
    for (int i = 0; i < kRays; ++i) {
      const ShaderRay made = Twins::ray(field, i, kRays);
      glsl::ScarpRay ray;
      glsl::ScarpHit hit = glsl::scarp_no_hit();
      if (glsl::scarp_ray_from(ground, made.origin, made.direction, made.end, ray))
        hit = glsl::scarp_sampled(ground, ray, settings);
      twins.judge(march, made, hit.status, double{ray.travelled} + double{hit.time});
    }
    twins.conclude();
  }
}

// In a stretch that starts anywhere on a ray, points are where numerics.md says.
TEST(SinglePrecisionSampling, RestartsMidRay) {
  constexpr int kCols = 131'000, kRays = 4000;
  constexpr double kUnit = 0x1p-24;
  const HeightField field = HeightField::own(std::vector<float>(kCols * 3, 0.0F), kCols, 3);
  const MaxPyramid pyramid(field);
  glsl::host_field = &field;
  glsl::host_pyramid = &pyramid;
  const glsl::ScarpField on_device = device_field(field, &pyramid);
  const glsl::ScarpSampling settings = device_sampling(Sampling::naive, {}, 0, 0, 1);
  Random random(12);
  int far = 0;
  for (int i = 0; i < kRays; ++i) {
    Ray ray;
    ray.origin = {uniform(random, 0, kCols - 1), uniform(random, 0, 2), 100};
    ray.direction = {uniform(random, -1, 1), uniform(random, -1e-5, 1e-5), uniform(random, -1e-3, 1e-3)};
    const DeviceRay prepared = sampled_device_ray(field, ray);
    ASSERT_TRUE(prepared.marches);
    const glsl::ScarpRay& r = prepared.ray;
    glsl::ScarpStretch at = glsl::scarp_stretch_begin(on_device, r, settings);
    at.t = static_cast<float>(uniform(random, 0, 1)) * r.exit;
    glsl::scarp_stretch_to(at);
    const float last = std::min((r.end - at.s0) + r.end_low, glsl::kScarpStretch);
    const glsl::ScarpStretchFrame frame =
        glsl::scarp_stretch_frame(on_device, r, glsl::scarp_way(on_device, r, settings), settings, at.s0, last);
    const float t = at.t + static_cast<float>(uniform(random, 0, 1)) * (last - at.t);
    const glsl::ScarpStretchPoint point = glsl::scarp_stretch_point(on_device, frame, false, t);
    const double s = double{at.s0} + double{t};
    const auto along = [&](int axis) { return (double{r.direction[axis]} + double{r.direction_low[axis]}) * s; };
    for (int axis = 0; axis < 2; ++axis) {
      const double expected = r.cell[axis] + double{r.place[axis]} + double{r.place_low[axis]} + along(axis);
      const double found = (axis == 0 ? frame.x.cell + double{point.col} + double{point.u}
                                      : frame.y.cell + double{point.row} + double{point.v});
      const double way = std::abs(double{r.direction[axis]});
      const double roundings = last < glsl::kScarpStretch ? 12 : 3;  // the border changes the ray
      EXPECT_NEAR(found, expected, kUnit * (roundings * way * double{t} + 1) + 0x1p-29 * way * double{at.s0} + 0x1p-21)
          << text(ray);
    }
    const double above = ray.origin.z + along(2), rise = std::abs(double{r.direction.z});
    EXPECT_NEAR(double{point.clearance}, above,
                4 * kUnit * (std::abs(above) + rise * double{t}) + 0x1p-29 * rise * double{at.s0})
        << text(ray);
    far += at.s0 > 1e4F;
  }
  EXPECT_GT(far, kRays / 4);
}

// `lipschitz` without a tolerance stops before rounding could take a point below the ground.
TEST(SinglePrecisionSampling, LipschitzStopsAboveTheGround) {
  constexpr int kRays = 2000;
  const HeightField field = hills(1025, 65, Surface::bilinear);
  const MaxPyramid pyramid(field);
  glsl::host_field = &field;
  glsl::host_pyramid = &pyramid;
  MarchSettings all;
  all.lipschitz = {.tolerance = 0, .max_steps = 100'000};
  const glsl::ScarpSampling settings = device_sampling(Sampling::lipschitz, all, slope_bound(field), 0, 1);
  Random random(13);
  int hits = 0;
  for (int i = 0; i < kRays; ++i) {
    Ray ray;
    ray.origin = {uniform(random, 0, 100), uniform(random, 0, 64), field.max_sample() + 1};
    ray.direction = {1, uniform(random, -0.03, 0.03), -uniform(random, 0.02, 0.2)};
    const DeviceRay prepared = sampled_device_ray(field, ray);
    ASSERT_TRUE(prepared.marches);
    const glsl::ScarpHit hit = lean(device_field(field, &pyramid), prepared.ray, settings, false);
    EXPECT_NE(hit.status, glsl::kScarpExhausted) << text(ray);
    hits += hit.status == glsl::kScarpHit;
  }
  EXPECT_GT(hits, kRays / 2);
}

// `lipschitz` over holes: otherwise it would take another step in a block that it has left.
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
    // Some rays are nearly along an axis: the slower a line is crossed, the more its time rounds.
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
