// SPDX-License-Identifier: MIT
#include "scarp/base/two_floats.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scarp/base/vec.h"

namespace scarp::test {
namespace {

struct Split {
  float high[3], low[3];
};

// Pairs of conversions side by side, in separate functions: g++ 12 folds them at -O2 if they are written as casts.
[[gnu::noinline]] dvec3 rounded(const dvec3& v) { return {as_float(v.x), as_float(v.y), as_float(v.z)}; }
[[gnu::noinline]] Split split_all(const dvec3& v) {
  Split all{};
  for (int axis = 0; axis < 3; ++axis) split(v[axis], all.high[axis], all.low[axis]);
  return all;
}

TEST(TwoFloats, RoundEveryComponentOfAVector) {
  const dvec3 v(0.1, 0.2, 1 + 0x1p-30);
  const dvec3 r = rounded(v);
  const Split all = split_all(v);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NE(r[axis], v[axis]);
    EXPECT_LE(std::abs(r[axis] - v[axis]), 0x1p-24 * v[axis]);
    EXPECT_NE(all.low[axis], 0);
    EXPECT_LE(std::abs(static_cast<double>(all.high[axis]) + static_cast<double>(all.low[axis]) - v[axis]),
              0x1p-48 * v[axis]);
  }
  EXPECT_EQ(r.z, 1);
  EXPECT_EQ(all.low[2], 0x1p-30F);
}

}  // namespace
}  // namespace scarp::test
