// SPDX-License-Identifier: MIT
// Steep waves and rays that descend to them, for shrink factors of lipschitz that are too large.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "march/height/spiteful.h"
#include "scarp/field/function_node.h"
#include "scarp/march/height/exhaustive.h"

namespace scarp::test {

constexpr double kWaveHeight = 6, kWavelength = 16;  // slopes up to 2.4

/// 129 x 129 samples, cells of 1 m.
inline HeightField waves() {
  std::vector<float> samples;
  for (int row = 0; row < 129; ++row) {
    for (int col = 0; col < 129; ++col)
      samples.push_back(static_cast<float>(kWaveHeight * std::sin(2 * std::numbers::pi * col / kWavelength)));
  }
  return HeightField::own(samples, 129, 129);
}
/// The same waves as a function, without a border.
inline Function endless_waves() { return make_function(Sines{{{kWaveHeight, kWavelength, 0, 0}}}); }

/// Rays that descend to them from above, 0.1 to 1 metre per metre.
inline std::vector<Ray> rays_over_waves(int count) {
  Random random(3);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    Ray ray{{uniform(random, 1, 30), uniform(random, 20, 108), uniform(random, 7, 12)},
            {1, uniform(random, -0.2, 0.2), -uniform(random, 0.2, 1)}};
    ray.t_max = 90;
    rays.push_back(ray);
  }
  return rays;
}

/// Fails unless all rays hit, many of them beyond the first ground, and some of these below the ground.
inline void expect_hits_under_the_ground(const HeightField& field, const std::vector<Ray>& rays,
                                         const std::vector<Hit>& hits) {
  int late = 0, under = 0, missed = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit judge = march_exhaustive({&field, nullptr}, rays[i], {}, nullptr);
    ASSERT_TRUE(judge);
    missed += !hits[i];
    if (!hits[i]) continue;
    const dvec3 p = rays[i].at(hits[i].t);
    const auto ground = field.height(p.x, p.y);
    late += hits[i].t > judge.t + 0.1;
    under += ground && p.z < *ground - 0.1;
  }
  EXPECT_EQ(missed, 0);
  EXPECT_GT(late, static_cast<int>(rays.size()) / 20);
  EXPECT_GT(under, static_cast<int>(rays.size()) / 50);
}

}  // namespace scarp::test
