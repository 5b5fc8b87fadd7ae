// SPDX-License-Identifier: MIT
// Rays that enter below the ground of a bowl, through its border or out of a hole in its side, rise out of it inside
// and descend again: the valid answers of each march, from those of `exhaustive`.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include "march/height/spiteful.h"
#include "scarp/march/height/exhaustive.h"
#include "scarp/march/height/height_table.h"

namespace scarp::test {

constexpr int kBowlSide = 65;

/// A bowl 30 m deep with a hill in it, cells of 1 m. `pierced`: holes in a ring along its border, 3 to 5 cells in.
inline HeightField bowl_field(bool pierced, bool solid) {
  std::vector<float> samples;
  for (int row = 0; row < kBowlSide; ++row) {
    for (int col = 0; col < kBowlSide; ++col) {
      const double r = std::hypot(col - 32, row - 32) / 32;
      const bool hole = pierced && std::abs(std::max(std::abs(col - 32), std::abs(row - 32)) - 28) <= 1;
      samples.push_back(hole ? std::numeric_limits<float>::quiet_NaN()
                             : static_cast<float>(30 * r * r + 14 * std::exp(-20 * r * r)));
    }
  }
  HeightFieldSettings settings;
  settings.solid = solid;
  return HeightField::own(samples, kBowlSide, kBowlSide, settings);
}

/// Rays through the border, or `from_holes` from within a hole, under the ground around, to a point above the bowl.
inline std::vector<Ray> entering_rays(const HeightField& field, bool from_holes, int count) {
  Random random(7);
  std::vector<Ray> rays;
  while (static_cast<int>(rays.size()) < count) {
    const double x = uniform(random, 8, 56), y = uniform(random, 8, 56);
    const auto ground = field.height(x, y);
    if (!ground) continue;
    const dvec3 target(x, y, *ground + uniform(random, 0.5, 8));
    const double along = uniform(random, 4, 60);
    dvec3 origin(from_holes ? 4 : -uniform(random, 1, 20), along, uniform(random, 2, 26));
    if (whole(random, 0, 1) == 1) origin = {origin.y, 64 - origin.x, origin.z};
    const Ray ray{origin, target - origin};
    // Deep enough below the rim, and leaving the ground between it and the position.
    const double in = from_holes ? 0.0 : std::max(-origin.x / ray.direction.x, (64 - origin.y) / ray.direction.y);
    const dvec3 p = from_holes ? ray.at(2.5 / length(dvec2(ray.direction))) : ray.at(in < 1 ? in + 1e-6 : 1);
    const auto rim = field.height(p.x, p.y);
    if (rim && p.z < *rim - 1) rays.push_back(ray);
  }
  return rays;
}

/// The answers of a march to rays, and whether it reports them as blocked.
using CastEntering =
    std::function<void(const HeightField& field, const std::vector<Ray>& rays, std::vector<Hit>& hits)>;

/// Fails if a march loses such rays, or hits where they enter.
inline void expect_entering_rays_go_on(const HeightMarchEntry& march, const CastEntering& cast) {
  constexpr int kRays = 300;
  for (const bool solid : {false, true}) {
    for (const bool pierced : {false, true}) {
      for (const bool from_holes : {false, true}) {
        if (from_holes && !pierced) continue;
        SCOPED_TRACE(testing::Message() << march.name << (solid ? ", solid" : "") << (pierced ? ", pierced" : "")
                                        << (from_holes ? ", from holes" : ""));
        const HeightField field = bowl_field(pierced, solid);
        const std::vector<Ray> rays = entering_rays(field, from_holes, kRays);
        std::vector<Hit> hits(rays.size());
        cast(field, rays, hits);
        int judged = 0, right = 0, lost = 0, early = 0, late = 0, gave_up = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          const Hit judge = march_exhaustive({&field, nullptr}, rays[i], {}, nullptr);
          EXPECT_EQ(judge.wall, solid);
          EXPECT_EQ(hits[i].wall, solid && hits[i]);
          judged += bool(judge);
          gave_up += hits[i].status == HitStatus::exhausted;
          if (hits[i].status == HitStatus::exhausted) continue;
          if (!judge) {
            early += bool(hits[i]);
            if (!hits[i]) {
              EXPECT_EQ(hits[i].status, judge.status);
            }
            continue;
          }
          lost += !hits[i];
          // Half a cell along the ray; walls are hit at the first sample behind them.
          const double near = (solid ? 1.5 : 0.5) / length(rays[i].direction);
          early += hits[i] && hits[i].t < judge.t - near, late += hits[i] && hits[i].t > judge.t + near;
          right += hits[i] && std::abs(hits[i].t - judge.t) <= near;
        }
        EXPECT_GT(judged, kRays * 3 / 4);
        if (march.guarantee != Guarantee::approximate || solid) {
          EXPECT_EQ(lost + late, 0);
        }
        EXPECT_LE(lost + early + late, judged / 30);
        // Behind a hole `lipschitz` cannot decide, and gives up.
        if (march.name == "lipschitz" && pierced && !solid) continue;
        EXPECT_GE(right, judged * 9 / 10)
            << lost << " lost, " << early << " early, " << late << " late, " << gave_up << " gave up";
      }
    }
  }
}

}  // namespace scarp::test
