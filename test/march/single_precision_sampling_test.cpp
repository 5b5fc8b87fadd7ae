// SPDX-License-Identifier: MIT
// The shader text of the marches that take samples, compiled as C++ with floats: they do what their texts say.
//
// Where a march decides by what it finds at points that earlier decisions have led it to, rounding can lead it to other
// points than the march in double; so each is held to its own rule, and fixed-step, whose points are known beforehand,
// to the answer in double.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "march/glsl_host.h"
#include "march/rounding_judge.h"
#include "march/spiteful.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/march/device_ray.h"
#include "scarp/march/fixed_step.glsl.h"
#include "scarp/march/fixed_step.h"
#include "scarp/march/lipschitz.glsl.h"
#include "scarp/march/naive.glsl.h"
#include "scarp/march/relaxed.glsl.h"

namespace scarp::test {
namespace {

constexpr int kFieldsPerPair = 2;
constexpr int kRaysPerField = 40;

struct Case {
  const HeightField& field;
  const MaxPyramid& pyramid;
  const Ray& ray;
  const RoundingJudge& judge;
};

// Calls check(case) for all spiteful fields and rays.
template <class Check>
void for_all(const Check& check) {
  for (const FieldKind& fields : spiteful_fields()) {
    for (const RayKind& rays : spiteful_rays()) {
      if ((fields.has & rays.aims_at) != rays.aims_at) continue;
      // The sampling marches in double take lengths for what doubles can square.
      if (rays.name == "a direction of extreme length") continue;
      Random random(fields.name.size() * 1000 + rays.name.size());
      for (int i = 0; i < kFieldsPerPair; ++i) {
        const HeightField field = fields.make(random);
        const MaxPyramid pyramid(field);
        glsl::host_field = &field;
        glsl::host_pyramid = &pyramid;
        for (int j = 0; j < kRaysPerField; ++j) {
          const Ray ray = rays.make(field, random);
          SCOPED_TRACE(fmt::format("{}, {} {}", fields.name, rays.name, j));
          check(Case{field, pyramid, ray, RoundingJudge(field, ray)});
          if (testing::Test::HasFailure()) return;
        }
      }
    }
  }
}

template <class March>
Hit run(const Case& c, const March& march) {
  const DeviceRay prepared = sampled_device_ray(c.field, c.ray);
  glsl::ScarpHit answer{};
  if (prepared.marches) answer = march(device_field(c.field, &c.pyramid), prepared.ray);
  return hit_from_device(c.ray, prepared, answer);
}

// The distance that tolerances go by, in metres.
double travelled(const Case& c, const Hit& hit) { return (hit.t - c.ray.t_min) * length(c.ray.direction); }

void expect_in_range(const Case& c, const Hit& hit) {
  if (!hit) return;
  EXPECT_GE(hit.t, c.ray.t_min);
  EXPECT_LE(hit.t, c.ray.t_max);
  EXPECT_TRUE(c.field.cell_heights(hit.cell));
}

TEST(SinglePrecisionSampling, NaiveStopsWhereItIsCloseOrBelow) {
  const NaiveSettings s;
  for_all([&](const Case& c) {
    const Hit hit = run(c, [&](const glsl::ScarpField& field, const glsl::ScarpRay& ray) {
      return glsl::scarp_naive(field, ray,
                               {static_cast<float>(s.step_factor), static_cast<float>(s.min_step),
                                static_cast<float>(s.tolerance), s.max_steps});
    });
    expect_in_range(c, hit);
    if (hit) {
      EXPECT_LE(c.judge.clearance_at(hit.t).low, s.tolerance * travelled(c, hit));
    }
  });
}

TEST(SinglePrecisionSampling, RelaxedStopsWhereItIsClose) {
  const RelaxedSettings s;
  for_all([&](const Case& c) {
    if (c.ray.start == RayStart::on_surface) return;
    const Hit hit = run(c, [&](const glsl::ScarpField& field, const glsl::ScarpRay& ray) {
      return glsl::scarp_relaxed(field, ray,
                                 {static_cast<float>(s.step_factor), static_cast<float>(s.tolerance), s.max_steps});
    });
    expect_in_range(c, hit);
    if (hit) {
      const auto [low, high] = c.judge.clearance_at(hit.t);
      EXPECT_LE(low, s.tolerance * travelled(c, hit));
      EXPECT_GE(high, -s.tolerance * travelled(c, hit));
    }
  });
}

TEST(SinglePrecisionSampling, LipschitzPassesNoHit) {
  for_all([&](const Case& c) {
    // What a ray from the surface steps over unseen is no hit that it passes.
    if (c.ray.start == RayStart::on_surface) return;
    const LipschitzSettings s;
    const double shrink = 1 / std::hypot(1.0, slope_bound(c.field));
    const Hit hit = run(c, [&](const glsl::ScarpField& field, const glsl::ScarpRay& ray) {
      return glsl::scarp_lipschitz(field, ray,
                                   {static_cast<float>(shrink), static_cast<float>(s.tolerance), s.max_steps});
    });
    expect_in_range(c, hit);
    if (hit.status == HitStatus::miss) {
      EXPECT_TRUE(c.judge.may_miss());
    }
    if (hit && !hit.wall) {
      const double at_most = (s.tolerance + 0x1p-20) * travelled(c, hit) / shrink;
      EXPECT_LE(c.judge.clearance_at(hit.t).low, at_most);
      EXPECT_GE(c.judge.clearance_at(hit.t).high, 0);
    }
  });
}

// Whether some sample of fixed-step up to t could be taken for another by rounding.
bool undecided(const Case& c, const FixedStepSettings& s, double t_begin, double t_end) {
  const double step = s.step * std::min(c.field.settings().cell_x, c.field.settings().cell_y) / length(c.ray.direction);
  for (double t = t_begin;; t += step) {
    const auto [low, high] = c.judge.clearance_at(std::min(t, t_end));
    if (low <= 0 && high >= 0) return true;
    if (t >= t_end) return false;
  }
}

TEST(SinglePrecisionSampling, FixedStepAnswersAsInDouble) {
  int agreed = 0, asked = 0;
  for (const bool interpolate : {false, true}) {
    for_all([&](const Case& c) {
      MarchSettings settings;
      FixedStepSettings& s = settings.fixed_step;
      s.interpolate = interpolate;
      const Hit hit = run(c, [&](const glsl::ScarpField& field, const glsl::ScarpRay& ray) {
        return glsl::scarp_fixed_step(field, ray, {static_cast<float>(s.step), interpolate, s.max_steps});
      });
      expect_in_range(c, hit);
      const Hit exact = march_fixed_step({&c.field, nullptr}, c.ray, settings);
      const double step =
          s.step * std::min(c.field.settings().cell_x, c.field.settings().cell_y) / length(c.ray.direction);
      if (hit.status == exact.status && (!hit || std::abs(hit.t - exact.t) <= 0.01 * step)) {
        ++agreed;
        return;
      }
      ++asked;
      const DeviceRay prepared = sampled_device_ray(c.field, c.ray);
      const double begin = prepared.begin * prepared.per_time;
      const double end = begin + static_cast<double>(prepared.ray.exit) * prepared.per_time;
      EXPECT_TRUE(undecided(c, s, begin, end));
    });
  }
  EXPECT_LT(asked, agreed / 10);
}

}  // namespace
}  // namespace scarp::test
