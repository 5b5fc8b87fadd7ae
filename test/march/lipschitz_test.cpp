// SPDX-License-Identifier: MIT
// lipschitz: it never passes the surface, on any field and ray, and reports when it gives up.
#include "scarp/march/height/height_sampling.h"
#include "scarp/march/sampling/shrink_factor.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "cases.h"
#include "march/height/spiteful.h"
#include "march/steep_waves.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/base/error.h"
#include "scarp/march/height/exhaustive.h"

namespace scarp::test {
namespace {

TEST(Lipschitz, ApproachesASlopeFromAbove) {
  std::vector<float> samples;
  for (int row = 0; row < 64; ++row) {
    for (int col = 0; col < 64; ++col) samples.push_back(static_cast<float>(2 * col));
  }
  const HeightField field = HeightField::own(samples, 64, 64);
  const MaxPyramid pyramid(field);
  const double slope = slope_bound(field);
  EXPECT_EQ(slope, 2);
  MarchStats stats;
  const Ray ray{{5, 30, 60}, {1, 0, 0}};
  const Hit hit = march_lipschitz({&field, &pyramid, slope}, ray, {}, &stats);
  ASSERT_TRUE(hit);
  // The plane is hit at x = 30. Where the march stops, shrink * h <= tolerance * t, and h = 2 (30 - x).
  EXPECT_LE(hit.t, 25);
  EXPECT_GE(hit.t, 25 - 0.0005 * 25 * std::sqrt(5.0) / 2);
  EXPECT_GT(stats.steps, 3u);
}

TEST(Lipschitz, AcceptsAShrinkFactorInsteadOfTheSlope) {
  const HeightField field = HeightField::own(std::vector<float>(81, 0.f), 9, 9);
  const MaxPyramid pyramid(field);
  MarchSettings settings;
  EXPECT_THROW(march_lipschitz({&field, &pyramid}, {{0, 4, 9}, {0.5, 0, -1}}, settings), Error);
  settings.lipschitz.shrink = 0.5;
  EXPECT_TRUE(march_lipschitz({&field, &pyramid}, {{0, 4, 9}, {0.5, 0, -1}}, settings));
  settings.lipschitz.max_steps = 2;
  EXPECT_EQ(march_lipschitz({&field, &pyramid}, {{0, 4, 9}, {0.5, 0, -1}}, settings).status, HitStatus::exhausted);
  settings.lipschitz.shrink = 1.5;
  EXPECT_THROW(validate(settings), Error);
}

// Like shaders whose factor was found by trial and error: rays pass through slopes, and hit where they are found to be
// below the ground.
TEST(Lipschitz, HitsBelowGroundWithAnUnprovenFactor) {
  const HeightField field = waves();
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid, slope_bound(field)};
  const std::vector<Ray> rays = rays_over_waves(500);
  std::vector<Hit> hits;
  MarchSettings settings;
  settings.lipschitz.shrink = 0.7;
  for (const Ray& ray : rays) hits.push_back(march_lipschitz(target, ray, settings));
  expect_hits_under_the_ground(field, rays, hits);
  EXPECT_EQ(lipschitz_guarantee(settings.lipschitz, target.slope), Guarantee::approximate);
  EXPECT_NE(lipschitz_caveat(settings.lipschitz, target.slope), "");
  // Without a slope bound nothing is proven.
  for (std::size_t i = 0; i < rays.size(); ++i)
    EXPECT_EQ(march_lipschitz({&field, &pyramid}, rays[i], settings), hits[i]);
}

TEST(Lipschitz, KeepsItsGuaranteeWithASmallerFactor) {
  const HeightField field = waves();
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid, slope_bound(field)};
  MarchSettings proven, smaller;
  proven.lipschitz.shrink = largest_proven_shrink(target.slope);
  smaller.lipschitz.shrink = 0.5 * proven.lipschitz.shrink;
  EXPECT_EQ(lipschitz_guarantee(proven.lipschitz, target.slope), Guarantee::conservative);
  EXPECT_EQ(lipschitz_caveat(proven.lipschitz, target.slope), "");
  for (const Ray& ray : rays_over_waves(200)) {
    const Hit oracle = march_exhaustive(target, ray), hit = march_lipschitz(target, ray, smaller);
    EXPECT_EQ(march_lipschitz(target, ray, proven), march_lipschitz(target, ray));
    EXPECT_TRUE(hit.status == oracle.status || hit.status == HitStatus::exhausted);
    if (hit) {
      EXPECT_LE(hit.t, oracle.t);
    }
  }
}

TEST(Lipschitz, NeverPassesTheSurface) {
  const int kFields = cases(40, 10, 4);
  constexpr int kRays = 50;
  int hits = 0, exhausted = 0, oracle_hits = 0;
  for (const FieldKind& fields : spiteful_fields()) {
    for (const RayKind& rays : spiteful_rays()) {
      // Their squares overflow, which the sampling marches do not support.
      if (rays.name == "a direction of extreme length") continue;
      Random random(17);
      for (int f = 0; f < kFields; ++f) {
        const HeightField field = fields.make(random);
        const MaxPyramid pyramid(field);
        const HeightTarget target{&field, &pyramid, slope_bound(field)};
        for (int i = 0; i < kRays; ++i) {
          const Ray ray = rays.make(field, random);
          // From the surface the first cell is skipped.
          if (ray.start == RayStart::on_surface) continue;
          const Hit hit = march_lipschitz(target, ray), oracle = march_exhaustive(target, ray);
          hits += bool(hit), exhausted += hit.status == HitStatus::exhausted, oracle_hits += bool(oracle);
          if (!oracle || hit.status == HitStatus::exhausted || hit.status == HitStatus::below) continue;
          // 2^-18 of a cell: the distance that a ray leaving a block may pass at the rim of a hole. It may miss a touch
          // that the oracle hits within rounding (32 roundings, as in oracle_test.cpp).
          const double cell = std::max(field.settings().cell_x, field.settings().cell_y) / length(ray.direction);
          if (hit && hit.t <= oracle.t + 0x1p-18 * cell) continue;
          Ray before = ray;
          before.t_max = hit ? std::min(hit.t, ray.t_max) : ray.t_max;
          const auto is_under = [&](double t) {
            const dvec3 p = ray.at(t);
            const auto ground = field.height(p.x, p.y);
            const double reach = std::abs(p.z) + length(ray.origin) + field.width() + field.depth();
            return ground && p.z < *ground - 0x1p-48 * reach * (1 + target.slope);
          };
          // A ray from below the ground may pass a short stretch above it.
          const double later = oracle.t + 0x1p-10 * cell;
          EXPECT_FALSE(is_under(later) && later < before.t_max && !is_under(oracle.t - 0x1p-10 * cell))
              << fields.name << ", " << rays.name << ": passed t = " << oracle.t << ", got "
              << (hit ? fmt::format("{}", hit.t) : "a miss");
        }
      }
    }
  }
  // Most hits are found, not given up.
  EXPECT_GT(hits, oracle_hits / 2);
  RecordProperty("hits", hits);
  RecordProperty("exhausted", exhausted);
}

}  // namespace
}  // namespace scarp::test
