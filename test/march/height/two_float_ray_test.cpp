// SPDX-License-Identifier: MIT
// Rays that shaders compute in two floats per number, and slopes of the ground for shading: the shader text, as C++.
#include "scarp/march/height/two_float_ray.glsl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "cases.h"
#include "march/glsl_host.h"
#include "march/height/rounding_judge.h"
#include "march/height/spiteful.h"
#include "march/height/spiteful_text.h"
#include "scarp/march/height/device_ray.h"
#include "scarp/march/height/height_marches.glsl.h"
#include "scarp/march/height/max_mip.glsl.h"
#include "scarp/march/height/surface_normal.glsl.h"

namespace scarp::test {
namespace {

const int kRaysPerPair = cases(1000, 250, 50);
constexpr int kRaysPerField = 250;
// Bounds of times and positions: see the header.
constexpr double kUnit = 0x1p-44;

void split(const dvec3& value, glsl::vec3& high, glsl::vec3& low) {
  high = glsl::vec3(value);
  low = glsl::vec3(value - dvec3(high));
}

// A time as two floats, limited to the range of the shader's floats.
glsl::ScarpTwoFloat two_floats(double t, int exponent) {
  const double time = std::min(std::ldexp(t, exponent), double{glsl::kScarpNever});
  return {static_cast<float>(time), static_cast<float>(time - static_cast<double>(static_cast<float>(time)))};
}

// The answer for a ray whose range starts at 0 or later.
Hit march(const HeightField& field, const MaxPyramid& pyramid, const Ray& ray, int turns) {
  const GridRay local = field.grid_from_world(ray);
  const dvec3& d = local.direction;
  const int exponent = std::ilogb(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}));
  glsl::ScarpLine line;
  split(local.origin, line.origin, line.origin_low);
  split({std::ldexp(d.x, -exponent), std::ldexp(d.y, -exponent), std::ldexp(d.z, -exponent)}, line.direction,
        line.direction_low);
  const glsl::ScarpTwoFloat begin = two_floats(ray.t_min, exponent), end = two_floats(ray.t_max, exponent);
  const glsl::ScarpField ground = device_field(field, &pyramid);
  const bool strict = ray.start == RayStart::on_surface;
  const glsl::ScarpRay host = strict ? device_ray(field, ray).ray : glsl::ScarpRay{};
  glsl::ScarpSent sent =
      glsl::scarp_send(ground, line, begin, end, strict ? glsl::kScarpSendFromSurface : 0, host.cell, host.place);
  DeviceRay prepared;
  prepared.marches = sent.marches != 0;
  glsl::ScarpHit answer = glsl::scarp_no_hit();
  if (prepared.marches) {
    // In pieces, for drivers that limit the length of a loop.
    glsl::ScarpWalk walk;
    if (glsl::scarp_begin_walk(ground, sent.ray, walk, answer)) {
      while (!glsl::scarp_go_on(ground, sent.ray, false, turns, walk, answer)) {
      }
    }
    const glsl::ScarpTwoFloat t = glsl::scarp_sent_time(sent, answer);
    answer.time = t.high;
    answer.time_low = t.low;
  }
  prepared.per_time = std::ldexp(1.0, -exponent);
  return hit_from_device(ray, prepared, answer);
}

class TwoFloatRays : public testing::TestWithParam<Pair> {};

TEST_P(TwoFloatRays, MatchTheSurface) {
  const auto [field_kind, ray_kind] = GetParam();
  const FieldKind& fields = spiteful_fields()[field_kind];
  const RayKind& rays = spiteful_rays()[ray_kind];
  Random random(77 * field_kind + ray_kind);
  for (int done = 0; done < kRaysPerPair; done += kRaysPerField) {
    const HeightField field = fields.make(random);
    if (!field.has_cells() || field.all_nodata()) continue;
    const MaxPyramid pyramid(field);
    glsl::host_field = &field;
    glsl::host_pyramid = &pyramid;
    for (int i = 0; i < std::min(kRaysPerPair, kRaysPerField); ++i) {
      Ray ray = rays.make(field, random);
      // Shaders start their rays at 0, or some cells later.
      const GridRay local = field.grid_from_world(ray);
      const double skipped = ray.start == RayStart::on_surface || i % 2 == 0 ? 0 : 3 / length(local.direction);
      ray.origin = ray.at(ray.t_min - skipped);
      ray.t_max -= ray.t_min - skipped;
      ray.t_min = skipped;
      // Floats count cells up to 2^31. Directions have the lengths of camera rays.
      const dvec3 origin = field.grid_from_world(ray).origin;
      const double farthest = std::max(std::abs(origin.x), std::abs(origin.y));
      if (!(farthest < 0x1p30) || !(length(local.direction) > 0x1p-100 && length(local.direction) < 0x1p100)) continue;
      if (field.wraps() && !(std::abs(ray.t_max) * length(local.direction) < 0x1p23)) continue;
      const Hit hit = march(field, pyramid, ray, 1 + i % 7);
      ASSERT_EQ(RoundingJudge(field, ray, 1024, kUnit).objection(hit), "")
          << fields.name << ", " << rays.name << ": " << text(ray) << "\n  " << text(hit);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Spiteful, TwoFloatRays, testing::ValuesIn(pairs()), name_of_pair);

TEST(TwoFloatRay, ResumesAfterAnInterruption) {
  Random random(5);
  for (const FieldKind& fields : spiteful_fields()) {
    const HeightField field = fields.make(random);
    if (!field.has_cells() || field.all_nodata()) continue;
    glsl::host_field = &field;
    const glsl::ScarpField ground = device_field(field, nullptr);
    for (int i = 0; i < 100; ++i) {
      const DeviceRay prepared = sampled_device_ray(field, spiteful_rays()[0].make(field, random));
      if (!prepared.marches) continue;
      const glsl::ScarpSampling settings =
          glsl::scarp_fixed_step(0.3f, i % 2 ? glsl::kScarpRefineSecant : glsl::kScarpRefineNone, 200);
      const glsl::ScarpHit whole = glsl::scarp_sampled(ground, prepared.ray, settings);
      glsl::ScarpHit pieces = glsl::scarp_no_hit();
      glsl::ScarpMarchState state = glsl::scarp_sampled_begin(ground, prepared.ray, settings);
      while (!glsl::scarp_sampled_on(ground, prepared.ray, settings, 3, state, pieces)) {
      }
      ASSERT_EQ(pieces.status, whole.status) << fields.name;
      ASSERT_EQ(pieces.time, whole.time) << fields.name;
      ASSERT_EQ(pieces.steps, whole.steps) << fields.name;
    }
  }
}

TEST(SinglePrecisionSlopes, MatchTheField) {
  Random random(9);
  int compared = 0;
  for (const FieldKind& fields : spiteful_fields()) {
    const HeightField field = fields.make(random);
    if (!field.has_cells() || field.all_nodata()) continue;
    glsl::host_field = &field;
    const glsl::ScarpField ground = device_field(field, nullptr);
    const HeightFieldSettings& settings = field.settings();
    const double metres = settings.scale * settings.exaggeration;
    for (int i = 0; i < 200; ++i) {
      const Cell cell{whole(random, 0, field.cell_cols() - 1), whole(random, 0, field.cell_rows() - 1)};
      if (!field.cell_heights(cell)) continue;
      const auto u = static_cast<float>(uniform(random, 0, 1)), v = static_cast<float>(uniform(random, 0, 1));
      const auto normal = [&](const glsl::vec2& slope) {
        return normalize(
            dvec3(-double{slope.x} * metres / settings.cell_x, double{slope.y} * metres / settings.cell_y, 1.0));
      };
      // Eight roundings of differences, relative to the largest sample: an angle of this multiple of the slope.
      const double steepest = std::max(std::abs(field.min_sample()), std::abs(field.max_sample())) * metres /
                              std::min(settings.cell_x, settings.cell_y);
      const double bound = 16 * 0x1p-24 * (1 + steepest);
      EXPECT_LE(length(normal(glsl::scarp_slope(ground, {cell.col, cell.row}, {u, v})) -
                       field.normal(cell, double{u}, double{v})),
                bound)
          << fields.name;
      EXPECT_LE(length(normal(glsl::scarp_shading_slope(ground, {cell.col, cell.row}, {u, v})) -
                       field.shading_normal(cell, double{u}, double{v})),
                bound)
          << fields.name;
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
}

}  // namespace
}  // namespace scarp::test
