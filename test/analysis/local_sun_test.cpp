// SPDX-License-Identifier: MIT
// Shadows with a separate sun position for every node, against the judge with the same rays, and on small fields
// against a single sun position.
#include "scarp/analysis/local_sun.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "analysis/slow_judge.h"
#include "scarp/analysis/sun_disc.h"
#include "scarp/base/error.h"

namespace scarp::test {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

// A field in degrees, its north-west node at (west, north), rotated clockwise from true north.
struct Ground {
  HeightField field;
  double west, north, step, turn = 0;

  dvec3 place(int col, int row) const {
    const double x = step * col, y = -step * row;
    return {west + x * std::cos(turn) + y * std::sin(turn), north + y * std::cos(turn) - x * std::sin(turn), 0};
  }
  LocalSun sun(const std::string& time) const {
    return {parse_time(time), false, [this](int row, int first_col, std::span<dvec3> places) {
              for (std::size_t i = 0; i < places.size(); ++i) places[i] = place(first_col + static_cast<int>(i), row);
            }};
  }
};

HeightField rough(int cols, int rows, double cell_x, double cell_y, double relief) {
  std::mt19937 random(3);
  std::vector<float> heights;
  for (int i = 0; i < cols * rows; ++i)
    heights.push_back(i % 41 == 7 ? std::nanf("")
                                  : static_cast<float>(static_cast<double>(random() % 1000) / 1000 * relief));
  return HeightField::own(std::move(heights), cols, rows, {.cell_x = cell_x, .cell_y = cell_y});
}

constexpr const char* kEvening = "2026-10-21T17:10+02:00";

TEST(LocalSun, MatchesTheJudgePerNode) {
  for (const double turn : {0.0, 0.3}) {
    const Ground ground{rough(31, 23, 3000, 3000, 1500), 10, 46, 0.03, turn};
    const LocalSun sun = ground.sun(kEvening);
    const SightGround heights(ground.field);
    const auto codes = local_shadow(ground.field, sun, {0, 23});
    const auto shares = local_lit_share(ground.field, sun, {0, 23});
    int counts[4] = {}, partly = 0;
    for (int row = 0; row < 23; ++row)
      for (int col = 0; col < 31; ++col) {
        const auto i = static_cast<std::size_t>(row * 31 + col);
        ++counts[static_cast<int>(codes[i])];
        const auto height = heights.height({col, row});
        if (!height) {
          EXPECT_EQ(codes[i], Shade::hole);
          EXPECT_EQ(shares[i], kNoShare);
          continue;
        }
        const dvec3 at = ground.place(col, row);
        const int west = std::max(col - 1, 0), east = std::min(col + 1, 30), up = std::max(row - 1, 0),
                  down = std::min(row + 1, 22);
        const NodeSteps steps = node_steps(at, ground.place(west, row), ground.place(east, row), east - west,
                                           ground.place(col, up), ground.place(col, down), down - up);
        const SunPosition position = sun_position(sun.time, {at.x * kRadians, at.y * kRadians, *height});
        EXPECT_EQ(codes[i], judge_shade(heights, sun_ray(steps, {position.azimuth, position.altitude}), {col, row}));
        partly += shares[i] > 0.01f && shares[i] < 0.99f;
        if (i % 3 != 0) continue;
        float share = 0;
        for (const SunStrip& strip : sun_strips())
          if (judge_shade(heights, sun_ray(steps, {position.azimuth, position.altitude + strip.rise}), {col, row}) ==
              Shade::lit)
            share += strip.share;
        EXPECT_EQ(shares[i], share);
      }
    for (const int count : counts) EXPECT_GT(count, 5);
    EXPECT_GT(partly, 0);
  }
}

// Degrees of latitude and longitude at 46 degrees north: 111,151 m and 77,463 m.
TEST(LocalSun, StepsAreGroundDistances) {
  const auto steps = node_steps({10, 46, 0}, {9.99, 46, 0}, {10.01, 46, 0}, 2, {10, 46.01, 0}, {10, 45.99, 0}, 2);
  EXPECT_NEAR(steps.col.x, 774.63, 0.05);
  EXPECT_NEAR(steps.row.y, -1111.51, 0.05);
  constexpr double kSpaceRounding = 4 * 6378137.0 / (std::int64_t{1} << 53);  // of points in space
  EXPECT_NEAR(steps.col.y, 0, kSpaceRounding);
  EXPECT_NEAR(steps.row.x, 0, kSpaceRounding);
  // Across the antimeridian.
  EXPECT_NEAR(node_steps({180, 46, 0}, {179.99, 46, 0}, {-179.99, 46, 0}, 2, {180, 46.01, 0}, {180, 45.99, 0}, 2).col.x,
              774.63, 0.05);
  // At the north pole, 0.01 degrees of latitude away: north of longitude 0 is towards longitude 180.
  const auto pole = node_steps({0, 90, 0}, {-90, 89.99, 0}, {90, 89.99, 0}, 2, {180, 89.99, 0}, {0, 89.99, 0}, 2);
  EXPECT_NEAR(pole.col.x, 1116.94, 0.05);
  EXPECT_NEAR(pole.col.y, 0, kSpaceRounding);
  EXPECT_NEAR(pole.row.x, 0, kSpaceRounding);
  EXPECT_NEAR(pole.row.y, -1116.94, 0.05);
  EXPECT_THROW(sun_ray({{0, 0}, {0, -1}}, {.azimuth = 1, .altitude = 1}), Error);
}

// Over 20 km the sun's position changes by 0.2 degree: few nodes differ from those under a single sun position.
TEST(LocalSun, BarelyVariesOverASmallField) {
  const double step = 0.002, north = 46 * kRadians;
  const HeightField field = rough(90, 90, step * 111320 * std::cos(north), step * 111151, 400);
  const Ground ground{field, 10, 46 + 45 * step, step};
  const LocalSun sun = ground.sun(kEvening);
  const SunPosition centre = sun_position(sun.time, {(10 + 45 * step) * kRadians, north, 30});
  const auto local = local_shadow(field, sun, {0, 90}), one = shadow(field, {centre.azimuth, centre.altitude});
  int different = 0, dark = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    different += local[i] != one[i];
    dark += one[i] == Shade::cast_shadow || one[i] == Shade::self_shaded;
  }
  EXPECT_GT(dark, 1000);
  EXPECT_GT(different, 0);
  EXPECT_LT(different, 100);
  // A band equals these rows of the whole map.
  const auto band = local_shadow(field, sun, {31, 50});
  EXPECT_TRUE(std::equal(band.begin(), band.end(), local.begin() + 31 * 90));
  EXPECT_THROW(local_shadow(field, sun, {31, 91}), Error);
}

// At an equinox the sun rises at 90 degrees east at midnight UTC, give or take the equation of time.
TEST(LocalSun, NightIsSelfShaded) {
  const Ground ground{HeightField::own(std::vector<float>(61, 5), 61, 1), 60, 0, 1};
  const auto codes = local_shadow(ground.field, ground.sun("2026-03-20T00:00Z"), {0, 1});
  EXPECT_EQ(codes[20], Shade::self_shaded);
  EXPECT_EQ(codes[40], Shade::lit);
  const auto rise = std::find(codes.begin(), codes.end(), Shade::lit) - codes.begin();
  EXPECT_NEAR(static_cast<double>(60 + rise), 90 + 7.5 / 4, 1);
  EXPECT_EQ(local_lit_share(ground.field, ground.sun("2026-03-20T00:00Z"), {0, 1})[0], 0);
}

}  // namespace
}  // namespace scarp::test
