// SPDX-License-Identifier: MIT
#include "scarp/accel/slope_bound.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace scarp {
namespace {

TEST(SlopeBound, EqualsTheSlopeOfAPlane) {
  std::vector<float> samples;
  for (int row = 0; row < 7; ++row) {
    for (int col = 0; col < 5; ++col) samples.push_back(static_cast<float>(30 * col + 40 * row));
  }
  EXPECT_DOUBLE_EQ(slope_bound(HeightField::own(samples, 5, 7, {.cell_x = 10, .cell_y = 10, .exaggeration = 2})), 10);
}

TEST(SlopeBound, IgnoresHoles) {
  EXPECT_DOUBLE_EQ(slope_bound(HeightField::own<float>({0, 0, std::nanf(""), 0, 1, 900}, 3, 2)), std::sqrt(2));
}

RC_GTEST_PROP(SlopeBound, IsNeverExceededAndIsAttainedAtACorner, ()) {
  std::vector<float> samples;
  for (int i = 0; i < 12; ++i) samples.push_back(static_cast<float>(*rc::gen::inRange(-500, 500)));
  const HeightField field = HeightField::own(samples, 4, 3, {.cell_x = 2, .cell_y = 5, .scale = 0.5});
  const double bound = slope_bound(field);
  double steepest = 0;
  for (int row = 0; row < 2; ++row) {
    for (int col = 0; col < 3; ++col) {
      for (int i = 0; i <= 8; ++i) {
        for (int j = 0; j <= 8; ++j)
          steepest = std::max(steepest, length(field.gradient(Cell{col, row}, i / 8.0, j / 8.0)));
      }
    }
  }
  // All quantities are multiples of 1/320 up to 1,000, or a square root of these: a few units in the last place.
  RC_ASSERT(std::abs(steepest - bound) <= 8 * 0x1p-52 * bound);
}

}  // namespace
}  // namespace scarp
