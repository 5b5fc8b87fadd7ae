// SPDX-License-Identifier: MIT
#include "scarp/march/height/cell_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace scarp {
namespace {

TEST(EdgeHeight, StaysBetweenItsNodesDespiteRounding) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> height(-1, 1), place(-0.5, 1.5);
  int beyond_without = 0;
  for (int i = 0; i < 100'000; ++i) {
    // At the far node a + 1 * (b - a) need not be b.
    const double a = height(random), b = height(random), f = i % 2 ? 1.0 : place(random);
    const double h = edge_height(a, b, f);
    ASSERT_GE(h, std::min(a, b));
    ASSERT_LE(h, std::max(a, b));
    const double plain = a + std::clamp(f, 0.0, 1.0) * (b - a);
    beyond_without += plain < std::min(a, b) || plain > std::max(a, b);
  }
  EXPECT_GT(beyond_without, 1000);
}

TEST(EdgeHeight, MatchesTheNodes) {
  EXPECT_EQ(edge_height(3, 7, 0), 3);
  EXPECT_EQ(edge_height(3, 7, 1), 7);
  EXPECT_EQ(edge_height(7, 3, 0.25), 6);
}

}  // namespace
}  // namespace scarp
