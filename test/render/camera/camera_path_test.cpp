// SPDX-License-Identifier: MIT
#include "scarp/render/camera/camera_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scarp/base/error.h"

namespace scarp {
namespace {

TEST(CameraPath, PassesThroughItsPoints) {
  const std::vector<CameraStation> stations{
      {{0, 0, 10}, {0, 50, 0}}, {{30, 5, 12}, {40, 60, 0}}, {{31, 8, 12}, {41, 60, 5}}, {{90, -20, 40}, {0, 0, 0}}};
  const CameraPath path(stations);
  EXPECT_EQ(path.at(0).eye, stations.front().eye);
  EXPECT_LT(length(path.at(1).target - stations.back().target), 1e-12);
  for (const CameraStation& station : stations) {
    // The nearest of many positions on the path: one of them is at most half of the largest step away.
    double nearest = 1e9, step = 0;
    constexpr int kPlaces = 20000;
    for (int i = 0; i <= kPlaces; ++i) {
      const CameraStation here = path.at(i / double{kPlaces});
      nearest = std::min(nearest, length(here.eye - station.eye) + length(here.target - station.target));
      if (i > 0) {
        const CameraStation before = path.at((i - 1) / double{kPlaces});
        step = std::max(step, length(here.eye - before.eye) + length(here.target - before.target));
      }
    }
    EXPECT_LE(nearest, step / 2);
    EXPECT_LT(step, 0.1) << "no jumps";
  }
}

TEST(CameraPath, IsStraightBetweenCollinearPoints) {
  const CameraPath path({{{0, 0, 5}, {0, 1, 5}}, {{10, 0, 5}, {10, 1, 5}}, {{20, 0, 5}, {20, 1, 5}}});
  for (int i = 0; i <= 20; ++i) {
    const CameraStation here = path.at(i / 20.0);
    EXPECT_NEAR(here.eye.x, i, 1e-12) << "evenly spaced stations, even speed";
    EXPECT_NEAR(here.eye.y, 0, 1e-12);
    EXPECT_NEAR(here.target.y, 1, 1e-12);
  }
}

TEST(CameraPath, SupportsStandingStillAndSinglePoints) {
  const CameraPath still({{{0, 0, 5}, {0, 1, 5}}, {{0, 0, 5}, {1, 0, 5}}});
  EXPECT_LT(length(still.at(0.5).eye - dvec3(0, 0, 5)), 1e-12);
  EXPECT_GT(still.at(0.5).target.x, 0.4);
  EXPECT_EQ(CameraPath({{{1, 2, 3}, {4, 5, 6}}}).at(0.7).eye, dvec3(1, 2, 3));
  EXPECT_THROW(CameraPath({}), Error);
}

}  // namespace
}  // namespace scarp
