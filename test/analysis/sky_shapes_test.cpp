// SPDX-License-Identifier: MIT
// Horizons and sky views of shapes whose answer is known: a ramp, valleys, a bowl, a dome and cones; and turned ground.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "scarp/analysis/horizon.h"
#include "scarp/analysis/sky_view.h"

namespace scarp {
namespace {

constexpr double kPi = std::numbers::pi, kCell = 10;

// Two heights below 2^11 m, each rounded by 2^-14 m, over a cell or more; four roundings of a slope below 2.
constexpr double kHorizon = 0x1p-13 / 8 + 4 * 0x1p-23;
// Sums of at most 512 floats of at most 1, relative to their number: each addition rounds by 2^-24 of the sum.
constexpr double kSum = 512 * 0x1p-24;

// The height at an offset in metres east and north of the middle node.
using Ground = std::function<double(double, double)>;

// 2 * reach + 1 nodes in each direction.
HeightField field_of(const Ground& ground, int reach, double cell_x = kCell, double cell_y = kCell) {
  std::vector<float> heights;
  for (int row = -reach; row <= reach; ++row)
    for (int col = -reach; col <= reach; ++col)
      heights.push_back(static_cast<float>(ground(col * cell_x, -row * cell_y)));
  const int side = 2 * reach + 1;
  return HeightField::own(std::move(heights), side, side, {.cell_x = cell_x, .cell_y = cell_y});
}

HorizonSettings flat_earth(HorizonEngine engine = HorizonEngine::exact) {
  HorizonSettings settings;
  settings.curvature.coefficient = 0;
  settings.engine = engine;
  return settings;
}

// Sky fraction and sky view factor of the middle node.
struct Sky {
  double fraction, factor;
};
Sky sky_of(const HeightField& field, int azimuths, HorizonEngine engine) {
  const SkyView sky(field, flat_earth(engine), azimuths, {SkyMeasure::sky_fraction, SkyMeasure::sky_view_factor});
  const int middle = field.rows() / 2;
  const auto rows = sky.rows(middle, middle + 1);
  const auto at = static_cast<std::size_t>(middle);
  return {static_cast<double>(rows[0][at]), static_cast<double>(rows[1][at])};
}

double slope_of(const HeightField& field, int col, int row, double azimuth) {
  const HorizonRows found = Horizons(field, flat_earth()).rows(azimuth, row, row + 1);
  return std::tan(static_cast<double>(found.angle[static_cast<std::size_t>(col)]));
}

constexpr HorizonEngine kEngines[] = {HorizonEngine::exact, HorizonEngine::sweep};

TEST(SkyShapes, RampOf45DegreesSeesThreeQuarters) {
  const HeightField ramp = field_of([](double east, double) { return east; }, 16);
  for (const HorizonEngine engine : kEngines) {
    // The accuracy that 64 azimuths are asked for.
    EXPECT_NEAR(sky_of(ramp, 64, engine).fraction, 0.75, 0.0005);
  }
}

// On the bottom line of two planes of slope b: tan h = tan b |sin p|, p from the line. The mean of cos^2 h is cos b,
// that of sin h is 2 b / pi.
TEST(SkyShapes, InfiniteValley) {
  struct Valley {
    const char* along;
    double cell_x, cell_y, east, north;  // unit vector across
  };
  const double half = std::sqrt(0.5);
  for (const Valley& v : {Valley{"north", 10, 10, 1, 0}, Valley{"east", 10, 10, 0, 1},
                          Valley{"north-east", 10, 10, half, -half}, Valley{"north, oblong cells", 10, 8, 1, 0}}) {
    for (const double degrees : {5.0, 30.0, 45.0}) {
      const double slope = degrees * kPi / 180, rise = std::tan(slope);
      const HeightField field =
          field_of([&](double east, double north) { return rise * std::abs(v.east * east + v.north * north); }, 20,
                   v.cell_x, v.cell_y);
      constexpr int kAround = 360;
      // The trapezoid rule of a period: step^2 / 8 times the variation of the derivative, over 2 pi. That of sin h
      // jumps by 2 tan b on the line, and falls by as much between; that of cos^2 h has four extremes of at most tan^2
      // b.
      const double step = 2 * kPi / kAround, share = step * step / 8 / (2 * kPi);
      for (const HorizonEngine engine : kEngines) {
        const Sky sky = sky_of(field, kAround, engine);
        EXPECT_NEAR(sky.fraction, 1 - 2 * slope / kPi, kHorizon + kSum + share * 8 * rise) << v.along << degrees;
        EXPECT_NEAR(sky.factor, std::cos(slope), 3 * kHorizon + kSum + share * 8 * rise * rise) << v.along << degrees;
      }
    }
  }
}

// At the bottom of a hemisphere the rim is at 45 degrees all round. Between its nodes the ground is linear: at a
// distance d, it lies between heights that are at most a cell c nearer or farther, which are at most (d + c)^2 / R
// inside the rim, and R: tan h <= R / (R - c). Crossings two and a half cells behind the rim are as high as it.
TEST(SkyShapes, HemisphereBowl) {
  constexpr double kRadius = 50 * kCell;
  const HeightField bowl = field_of(
      [](double east, double north) {
        const double r2 = east * east + north * north;
        return r2 < kRadius * kRadius ? kRadius - std::sqrt(kRadius * kRadius - r2) : kRadius;
      },
      60);
  const double most = kRadius / (kRadius - kCell) + kHorizon, least = kRadius / (kRadius + 2.5 * kCell) - kHorizon;
  const auto sine = [](double slope) { return slope / std::sqrt(1 + slope * slope); };
  const Sky sky = sky_of(bowl, 64, HorizonEngine::exact);
  EXPECT_LE(sky.fraction, 1 - sine(least) + kSum);
  EXPECT_GE(sky.fraction, 1 - sine(most) - kSum);
  EXPECT_LE(sky.factor, 1 - sine(least) * sine(least) + kSum);
  EXPECT_GE(sky.factor, 1 - sine(most) * sine(most) - kSum);
}

// The horizon over a hemisphere of radius R, seen from a plain D away from its middle, has the sine R / D. A row of
// nodes has one within half a cell of the place where the line of sight touches; the ground there is lower than the
// line by at most half the square of the offset times the curvature R^2 / z^3 of the section.
TEST(SkyShapes, Dome) {
  constexpr double kRadius = 300;
  constexpr int kReach = 70;
  struct Side {
    double azimuth;
    int col, row;  // steps of the node from the middle
  };
  for (const double cell_y : {10.0, 8.0}) {
    const HeightField dome =
        field_of([](double east,
                    double north) { return std::sqrt(std::max(0.0, kRadius * kRadius - east * east - north * north)); },
                 kReach, kCell, cell_y);
    for (const Side& side : {Side{kPi / 2, -55, 0}, {-kPi / 2, 55, 0}, {0, 0, 55}, {kPi, 0, -55}}) {
      const double cell = side.col == 0 ? cell_y : kCell, distance = 55 * cell, offset = cell / 2;
      const double exact = kRadius / std::sqrt(distance * distance - kRadius * kRadius);
      const double touch = distance - kRadius * kRadius / distance;
      const double beside = std::abs(distance - touch) + offset;
      const double z = std::sqrt(kRadius * kRadius - beside * beside);
      const double lower = offset * offset / 2 * kRadius * kRadius / (z * z * z) / (touch - offset);
      const double found = slope_of(dome, kReach + side.col, kReach + side.row, side.azimuth);
      EXPECT_LE(found, exact + kHorizon);
      EXPECT_GE(found, exact - lower - kHorizon);
    }
    // All ground lies below its top.
    for (const HorizonEngine engine : kEngines) {
      EXPECT_NEAR(sky_of(dome, 64, engine).fraction, 1, kSum);
      EXPECT_NEAR(sky_of(dome, 64, engine).factor, 1, kSum);
    }
  }
}

// In the eight directions of the grid, crossings are nodes: a pit of slope b hides sin b of the sky, and cos^2 b of the
// radiation reaches its bottom. The top of a peak is the horizon of the plain.
TEST(SkyShapes, Cones) {
  for (const double degrees : {10.0, 30.0, 45.0}) {
    const double slope = degrees * kPi / 180, rise = std::tan(slope);
    const HeightField pit = field_of([&](double east, double north) { return rise * std::hypot(east, north); }, 24);
    for (const HorizonEngine engine : kEngines) {
      const Sky sky = sky_of(pit, 8, engine);
      EXPECT_NEAR(sky.fraction, 1 - std::sin(slope), kHorizon + kSum) << degrees;
      EXPECT_NEAR(sky.factor, std::pow(std::cos(slope), 2), 2 * kHorizon + kSum) << degrees;
    }
    constexpr double kTop = 12 * kCell;
    const HeightField peak =
        field_of([&](double east, double north) { return rise * std::max(0.0, kTop - std::hypot(east, north)); }, 24);
    EXPECT_NEAR(slope_of(peak, 4, 24, kPi / 2), rise * kTop / (20 * kCell), 2 * kHorizon) << degrees;
    EXPECT_NEAR(slope_of(peak, 4, 4, 3 * kPi / 4), rise * kTop / (20 * kCell * std::sqrt(2.0)), 2 * kHorizon)
        << degrees;
  }
}

// Ground that is turned by quarters has horizons turned by quarters. In radians a quarter is rounded, which may move
// the weight of a crossing by 2^-24 of the relief, over a cell.
TEST(SkyShapes, TurnedGroundHasTurnedHorizons) {
  constexpr int kReach = 12, kSide = 2 * kReach + 1;
  constexpr double kRelief = 64, kTurned = kRelief * 0x1p-24 / kCell + 4 * 0x1p-23 * kRelief / kCell;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> height(0, kRelief);
  std::vector<double> heights(kSide * kSide);
  for (double& one : heights) one = height(random);
  const auto at = [&](double east, double north) {
    const auto col = std::lround(east / kCell) + kReach, row = kReach - std::lround(north / kCell);
    return heights[static_cast<std::size_t>(row * kSide + col)];
  };
  const Horizons ground(field_of(at, kReach), flat_earth());
  const Horizons turned(field_of([&](double east, double north) { return at(-north, east); }, kReach), flat_earth());
  for (const double azimuth : {0.0, kPi / 4, 0.3, 1.1, 2.0, 4.4}) {
    const HorizonRows a = ground.rows(azimuth, 0, kSide), b = turned.rows(azimuth + kPi / 2, 0, kSide);
    for (int row = 0; row < kSide; ++row) {
      for (int col = 0; col < kSide; ++col) {
        const float here = a.angle[static_cast<std::size_t>(row * kSide + col)];
        // A quarter clockwise about the middle.
        const float there = b.angle[static_cast<std::size_t>(col * kSide + (kSide - 1 - row))];
        EXPECT_NEAR(static_cast<double>(here), static_cast<double>(there), kTurned)
            << azimuth << ' ' << col << ' ' << row;
      }
    }
  }
}

}  // namespace
}  // namespace scarp
