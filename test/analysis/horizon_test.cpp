// SPDX-License-Identifier: MIT
// Horizons and sky view: the engine against every crossing by the same expression, to the bit; against crossings found
// in long double without the table; and shapes whose answer is known.
#include "scarp/analysis/horizon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "analysis/horizon_shapes.h"
#include "march/instruction_sets.h"
#include "scarp/analysis/horizon_measures.h"
#include "scarp/analysis/horizon_scan.h"
#include "scarp/analysis/shadow.h"
#include "scarp/analysis/sky_view.h"
#include "scarp/analysis/sun_hours.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

using test::azimuth;
using test::HorizonShape;
using test::is_drawn;
using test::kAzimuths;
using test::kFieldsPerKind;
using test::kShapes;
using test::shape;

constexpr double kPi = std::numbers::pi;
constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

TEST(Horizons, EqualEveryCrossingToTheBit) {
  int differences = 0;
  const std::vector<std::int64_t> sets = test::instruction_sets();
  for (int s = 0; s < kShapes; ++s) {
    const HorizonShape made = shape(s);
    const HorizonGround ground(made.field, 1, made.eye);
    const NodeRect all{0, 0, made.field.cols(), made.field.rows()};
    const auto nodes = static_cast<std::size_t>(all.col_end) * static_cast<std::size_t>(all.row_end);
    for (int a = 0; a < kAzimuths; ++a) {
      if (!is_drawn(s, a)) continue;
      const test::InstructionSet set(sets[static_cast<std::size_t>(s + a) % sets.size()]);
      const HorizonTable table(
          ground, HorizonCrossings(made.field, azimuth(a), made.settings.max_distance, made.settings.curvature));
      std::vector<float> fast(nodes), slow(nodes);
      std::vector<std::int32_t> fast_entry(nodes), slow_entry(nodes);
      scan_horizon(ground, table, made.eye, all, fast.data(), fast_entry.data(), all.col_end);
      scan_horizon_by_all(ground, table, made.eye, all, slow.data(), slow_entry.data(), all.col_end);
      for (std::size_t i = 0; i < nodes; ++i) {
        if (std::isnan(slow[i]) && std::isnan(fast[i])) continue;
        differences += std::bit_cast<std::uint32_t>(fast[i]) != std::bit_cast<std::uint32_t>(slow[i]) ||
                       fast_entry[i] != slow_entry[i];
      }
    }
  }
  EXPECT_EQ(differences, 0);
}

// The horizon slope of a node by every grid line that the line of sight crosses, in long double, and the largest errors
// that the floats of the definition and the doubles of horizon_from() may have.
struct Judged {
  long double slope = -std::numeric_limits<long double>::infinity(), error = 0, error_in_double = 0;
};
Judged judge(const HorizonShape& made, int col, int row, double direction) {
  const HeightFieldSettings& cells = made.field.settings();
  const SightGround ground(made.field);
  const auto z = ground.height({col, row});
  const long double east = std::sin(static_cast<long double>(direction)) / cells.cell_x;
  const long double south = -std::cos(static_cast<long double>(direction)) / cells.cell_y;
  Judged judged;
  for (const bool by_column : {true, false}) {
    const long double ahead = by_column ? east : south, aside = by_column ? south : east;
    // A double's azimuth of a quarter turn is off by less.
    if (std::abs(ahead) < 0x1p-45L * std::abs(aside)) continue;
    const int lines = by_column ? made.field.cols() : made.field.rows();
    for (int line = 0; line < lines; ++line) {
      const long double distance = (line - (by_column ? col : row)) / ahead;
      if (!(distance > 0) || distance > made.settings.max_distance) continue;
      long double place = (by_column ? row : col) + aside * distance;
      if (std::abs(place - std::round(place)) < 0x1p-36L) place = std::round(place);
      const int low = static_cast<int>(std::floor(place)), across = by_column ? made.field.rows() : made.field.cols();
      const long double w = place - low;
      if (low < 0 || low + (w > 0) >= across) continue;
      const auto height = [&](int at) { return ground.height(by_column ? Node{line, at} : Node{at, line}); };
      const auto first = height(low), second = w > 0 ? height(low + 1) : first;
      if (!first || !second) continue;
      const long double side = by_column ? cells.cell_y : cells.cell_x, c = made.settings.curvature.per_square_metre();
      const long double drop = c * (distance * distance + w * (1 - w) * side * side) / distance;
      const long double eye = *z + static_cast<long double>(made.eye);
      const long double slope = (*first + w * (*second - *first) - eye) / distance - drop;
      judged.slope = std::max(judged.slope, slope);
      // Heights, the eye and w round once each (w also by 2^-36 of a cell), the differences and the sum once more, 1/D
      // and the drop once, the slope once.
      const long double tall = std::abs(*first) + std::abs(*second) + std::abs(eye);
      const auto error = [&](long double unit) {
        const long double of_ground = 4 * unit * tall + (unit + 0x1p-36L) * std::abs(*second - *first);
        return of_ground / distance + 3 * unit * (std::abs(slope) + drop);
      };
      judged.error = std::max(judged.error, error(0x1p-24L));
      judged.error_in_double = std::max(judged.error_in_double, error(0x1p-53L));
    }
  }
  return judged;
}

TEST(Horizons, EqualCrossingsInLongDouble) {
  int judged = 0;
  for (int s = 0; s < kShapes; ++s) {
    const HorizonShape made = shape(s);
    const Horizons horizons(made.field, made.settings);
    std::mt19937 random(static_cast<unsigned>(s));
    for (int a = 0; a < kAzimuths; ++a) {
      if (!is_drawn(s, a)) continue;
      const HorizonRows found = horizons.rows(azimuth(a), 0, made.field.rows());
      for (int i = 0; i < 12; ++i) {
        const int col = static_cast<int>(random() % static_cast<unsigned>(made.field.cols()));
        const int row = static_cast<int>(random() % static_cast<unsigned>(made.field.rows()));
        const float angle = found.angle[static_cast<std::size_t>(row) * static_cast<std::size_t>(made.field.cols()) +
                                        static_cast<std::size_t>(col)];
        if (!SightGround(made.field).height({col, row})) {
          EXPECT_TRUE(std::isnan(angle));
          continue;
        }
        const Judged truth = judge(made, col, row, azimuth(a));
        ++judged;
        if (std::isinf(truth.slope)) {
          EXPECT_EQ(angle, static_cast<float>(-kPi / 2));
          continue;
        }
        // An angle moves by no more than its slope; horizon_measures.h has the bound of the angle itself.
        const double allowed = static_cast<double>(truth.error) + 0x1p-22;
        EXPECT_NEAR(static_cast<double>(angle), static_cast<double>(std::atan(truth.slope)), allowed)
            << "shape " << s << ", azimuth " << azimuth(a) << ", node " << col << ", " << row;
        const auto view = horizon_from(made.field, col, row, azimuth(a), made.settings);
        ASSERT_TRUE(view);
        EXPECT_NEAR(view->angle, static_cast<double>(std::atan(truth.slope)),
                    static_cast<double>(truth.error_in_double) + 0x1p-52);
      }
    }
  }
  EXPECT_GT(judged, 1000 * kFieldsPerKind);
}

TEST(Horizons, CellsOfAPlaceAreThoseOfAFieldWithThem) {
  std::mt19937 random(9);
  std::vector<float> samples(40 * 50);
  for (float& sample : samples) sample = static_cast<float>(random() % 99);
  const auto field = HeightField::view(samples.data(), 40, 50, {.cell_x = 10, .cell_y = 10});
  const auto other = HeightField::view(samples.data(), 40, 50, {.cell_x = 12.5, .cell_y = 9.25});
  int different = 0;
  const auto share = [&](unsigned below) { return static_cast<double>(random() % below) / 100; };
  for (int i = 0; i < 200; ++i) {
    const double col = share(3900), row = share(4900), turn = share(628);
    const auto wanted = horizon_from(other, col, row, turn), own = horizon_from(field, col, row, turn);
    const auto found = horizon_from(field, col, row, turn, {}, dvec2(12.5, 9.25));
    ASSERT_TRUE(wanted && own && found);
    EXPECT_EQ(wanted->angle, found->angle);
    EXPECT_EQ(wanted->distance, found->distance);
    different += own->angle != found->angle;
  }
  EXPECT_GT(different, 100);
  EXPECT_THROW(horizon_from(field, 1, 1, 0, {}, dvec2(0, 1)), Error);
}

// The bound of horizon_measures.h, at every 16411th float; the same bits with every instruction set.
TEST(Horizons, AnglesAreArcTangents) {
  std::vector<float> slopes{0, -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()};
  for (std::uint32_t bits = 0; bits < 0x7f800000u; bits += 16411) {
    slopes.push_back(std::bit_cast<float>(bits));
    slopes.push_back(-slopes.back());
  }
  slopes.push_back(kHole);
  std::vector<float> angles(slopes.size()), others(slopes.size());
  find_angles(slopes.data(), slopes.size(), angles.data());
  EXPECT_TRUE(std::isnan(angles.back()));
  double largest = 0;
  for (std::size_t i = 0; i + 1 < slopes.size(); ++i)
    largest = std::max(largest, std::abs(static_cast<double>(angles[i]) - std::atan(static_cast<double>(slopes[i]))));
  EXPECT_LT(largest, 0x1p-22);
  EXPECT_EQ(angles[1], -angles[2]);
  for (const std::int64_t set : test::instruction_sets()) {
    const test::InstructionSet selected(set);
    find_angles(slopes.data(), slopes.size(), others.data());
    EXPECT_TRUE(std::equal(angles.begin(), angles.end() - 1, others.begin()));
  }
}

// Also equal where both are NaN.
std::vector<std::uint32_t> bits(const std::vector<float>& values) {
  std::vector<std::uint32_t> all;
  for (const float value : values) all.push_back(std::isnan(value) ? 0x7fc00000u : std::bit_cast<std::uint32_t>(value));
  return all;
}

TEST(Horizons, DependOnNoBandAndNoThread) {
  for (const HorizonEngine engine : {HorizonEngine::exact, HorizonEngine::sweep}) {
    HorizonShape made = shape(7);
    made.settings.engine = engine;
    const Horizons horizons(made.field, made.settings);
    for (const double azimuth : {1.2345, 0.2345, 3.0, 4.5, kPi, 1.5 * kPi}) {
      const HorizonRows whole = horizons.rows(azimuth, 0, made.field.rows(), true);
      const ThreadLimit one(1);
      HorizonRows parts;
      for (int row = 0; row < made.field.rows(); row += 3) {
        const HorizonRows part = horizons.rows(azimuth, row, std::min(row + 3, made.field.rows()), true);
        parts.angle.insert(parts.angle.end(), part.angle.begin(), part.angle.end());
        parts.distance.insert(parts.distance.end(), part.distance.begin(), part.distance.end());
      }
      EXPECT_EQ(bits(parts.angle), bits(whole.angle));
      EXPECT_EQ(bits(parts.distance), bits(whole.distance));
    }
  }
}

// Blocks of a field, over cells of any lengths, are those of a field with such cells.
TEST(Horizons, BlocksHaveTheirOwnCells) {
  const std::vector measures{SkyMeasure::sky_view_factor, SkyMeasure::negative_openness};
  for (const HorizonEngine engine : {HorizonEngine::exact, HorizonEngine::sweep}) {
    HorizonShape made = shape(7);
    made.settings.engine = engine;
    HeightFieldSettings other = made.field.settings();
    other.cell_x *= 0.7, other.cell_y *= 1.1;
    std::vector<float> heights;
    for (int row = 0; row < made.field.rows(); ++row)
      for (int col = 0; col < made.field.cols(); ++col)
        heights.push_back(static_cast<float>(SightGround(made.field).height({col, row}).value_or(kHole)));
    const HeightField field = HeightField::own(std::move(heights), made.field.cols(), made.field.rows(), other);
    ASSERT_GT(field.cols(), 40);
    ASSERT_GT(field.rows(), 10);
    const NodeRect nodes{11, 5, 37, 9};
    const auto clipped = [&](const std::vector<float>& whole) {
      std::vector<float> part;
      for (int row = nodes.row_begin; row < nodes.row_end; ++row)
        for (int col = nodes.col_begin; col < nodes.col_end; ++col)
          part.push_back(whole[static_cast<std::size_t>(row * field.cols() + col)]);
      return bits(part);
    };
    const Horizons whole(field, made.settings),
        blocks = Horizons(made.field, made.settings).with_cells(other.cell_x, other.cell_y);
    for (const double azimuth : {1.2345, 0.2345, 3.0, 4.5, kPi, 1.5 * kPi}) {
      const HorizonRows expected = whole.rows(azimuth, 0, field.rows(), true);
      const HorizonRows found = blocks.block(azimuth, nodes, true);
      EXPECT_EQ(bits(found.angle), clipped(expected.angle));
      EXPECT_EQ(bits(found.distance), clipped(expected.distance));
    }
    const auto sky = SkyView(field, made.settings, 8, measures).rows(0, field.rows());
    const auto part = SkyView(made.field, made.settings, 8, measures).with_cells(other.cell_x, other.cell_y);
    const auto found = part.block(nodes);
    for (std::size_t m = 0; m < measures.size(); ++m) EXPECT_EQ(bits(found[m]), clipped(sky[m]));
    const SunMoment moments[] = {{{1, 0.3}, 1.5, 80}, {{4, 0.6}, 0.5, 80}};
    const auto clear = [&](std::span<const float> factor) { return ClearSkyGround{3, 0.2, factor}; };
    const std::vector<float> all(static_cast<std::size_t>(field.cols() * field.rows()), 0.9f), few(nodes.count(), 0.9f);
    const ClearSkyGround of_all = clear(all), of_few = clear(few);
    const SunHours hours = sun_hours(whole, moments, 0, field.rows(), &of_all);
    const SunHours of_block = sun_hours(blocks, moments, nodes, &of_few);
    EXPECT_EQ(bits(of_block.hours), clipped(hours.hours));
    EXPECT_EQ(bits(of_block.energy.beam), clipped(hours.energy.beam));
    EXPECT_EQ(bits(of_block.energy.reflected), clipped(hours.energy.reflected));
    for (const NodeRect& bad : {NodeRect{5, 5, 5, 6}, {-1, 0, 1, 1}, {0, 0, field.cols() + 1, 1}, {0, 0, 1, 0}})
      EXPECT_THROW(blocks.block(0, bad), Error);
    EXPECT_THROW(blocks.with_cells(0, 1), Error);
  }
}

TEST(Horizons, AzimuthsOfAFullTurnAreEqual) {
  const HorizonShape made = shape(16);
  const Horizons horizons(made.field, made.settings);
  for (const double turn : {0.0, kPi / 2, kPi}) {
    EXPECT_EQ(bits(horizons.rows(turn, 0, made.field.rows()).angle),
              bits(horizons.rows(turn + 2 * kPi, 0, made.field.rows()).angle));
  }
}

// A wall 100 m high, 400 m east of a flat plain.
TEST(Horizons, MeasureAWall) {
  std::vector<float> heights(101 * 101, 0);
  for (std::size_t row = 0; row < 101; ++row) heights[row * 101 + 90] = 100;
  const HeightField field = HeightField::own(std::move(heights), 101, 101, {.cell_x = 10, .cell_y = 10});
  HorizonSettings settings;
  settings.curvature.coefficient = 0;
  const HorizonRows east = Horizons(field, settings).rows(kPi / 2, 50, 51, true);
  EXPECT_FLOAT_EQ(east.angle[50], static_cast<float>(std::atan(100.0 / 400)));
  EXPECT_FLOAT_EQ(east.distance[50], 400);
  settings.max_distance = 399;
  EXPECT_FLOAT_EQ(Horizons(field, settings).rows(kPi / 2, 50, 51).angle[50], 0);
}

constexpr int kMiddle = 16;

HeightField plane(double slope, double aspect) {
  constexpr int kSide = 2 * kMiddle + 1;
  std::vector<float> heights;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      heights.push_back(static_cast<float>(-std::tan(slope) * 10 *
                                           (std::sin(aspect) * (col - kMiddle) + std::cos(aspect) * (kMiddle - row))));
    }
  }
  return HeightField::own(std::move(heights), kSide, kSide, {.cell_x = 10, .cell_y = 10});
}

// The middle of a plane sees (1 + cos b) / 2 of the radiation; the solid angle is 1 - sin of atan(tan b cos) averaged
// over the uphill half: 1 - b / pi.
TEST(SkyView, OfPlanesIsKnown) {
  const std::vector measures{SkyMeasure::sky_fraction, SkyMeasure::sky_view_factor, SkyMeasure::positive_openness,
                             SkyMeasure::negative_openness};
  // Two heights below 2^11 m, each rounded by 2^-14 m, over 10 m or more; four roundings of a slope below 2.
  constexpr double kHorizon = 0x1p-13 / 10 + 4 * 0x1p-23;
  // The sum of 64 floats, of at most pi / 2 each: each sum rounds by 2^-24 of its half on average.
  constexpr int kAround = 64;
  constexpr double kSum = 0x1p-18, kStep = 2 * kPi / kAround;
  HorizonSettings settings;
  settings.curvature.coefficient = 0;
  for (const double degrees : {0.0, 10.0, 30.0, 45.0, 60.0}) {
    for (const double aspect : {0.0, kPi / 2, 0.5, 4.0}) {
      settings.engine = aspect < 1 ? HorizonEngine::exact : HorizonEngine::sweep;
      const double slope = degrees * kPi / 180;
      const SkyView sky(plane(slope, aspect), settings, kAround, measures);
      const auto rows = sky.rows(kMiddle, kMiddle + 1);
      // The trapezoid rule of a period: step^2 / 8 times the variation of the first derivative, which is 4 tan b for
      // the sine of the horizon (monotone from tan b to -tan b uphill, 0 downhill) and 2 pi sin b for the radiation.
      const auto directions = [&](double variation) { return kStep * kStep / 8 * variation / (2 * kPi); };
      EXPECT_NEAR(static_cast<double>(rows[0][kMiddle]), 1 - slope / kPi,
                  kHorizon + kSum + directions(4 * std::tan(slope)))
          << degrees;
      // The slope of the plane comes from the heights, too.
      EXPECT_NEAR(static_cast<double>(rows[1][kMiddle]), (1 + std::cos(slope)) / 2,
                  3 * kHorizon + kSum + directions(2 * kPi * std::sin(slope)))
          << degrees;
      EXPECT_NEAR(static_cast<double>(rows[2][kMiddle]), kPi / 2, kHorizon + kSum) << degrees;
      EXPECT_NEAR(static_cast<double>(rows[3][kMiddle]), kPi / 2, kHorizon + kSum) << degrees;
    }
  }
}

TEST(SkyView, KeepsHolesAndRefusesSettings) {
  HeightField field = HeightField::own(std::vector<float>{1, 2, kHole, 4, 5, 6}, 3, 2);
  const std::vector one{SkyMeasure::sky_fraction};
  const auto rows = SkyView(field, {}, 8, one).rows(0, 2);
  EXPECT_TRUE(std::isnan(rows[0][2]));
  EXPECT_FALSE(std::isnan(rows[0][0]));
  EXPECT_THROW(SkyView(field, {}, 0, one), Error);
  EXPECT_THROW(Horizons(field, {.eye_height = -1}), Error);
  EXPECT_THROW(Horizons(field, {.max_distance = 0}), Error);
  EXPECT_THROW(Horizons(field, {.max_distance = 5, .engine = HorizonEngine::sweep}), Error);
  EXPECT_THROW(Horizons(field).rows(0, 0, 3), Error);
  EXPECT_THROW(Horizons(field).rows(std::numeric_limits<double>::quiet_NaN(), 0, 1), Error);
}

// Nodes that a sun lights for an hour are those that shadow() finds lit, by other rules: it decides exactly, and rounds
// the direction of the sun to 2^-27 cells per cell. Both may differ where the sun is on the horizon, and in directions
// through nodes on a border or beside a hole, which only one of them may meet: such directions are not drawn.
TEST(SunHours, AgreeWithShadows) {
  int compared = 0, close = 0;
  for (int s = 0; s < kShapes; ++s) {
    HorizonShape made = shape(s);
    made.settings = {};
    made.settings.curvature.coefficient = 0;
    const Horizons horizons(made.field, made.settings);
    for (int a = 13; a < 19; ++a) {
      if (!is_drawn(s, a)) continue;
      const SunDirection sun{azimuth(a), 0.05 + 0.2 * (a - 13)};
      const auto codes = shadow(made.field, sun);
      const SunMoment moments[] = {{sun, 1.0}};
      const SunHours hours = sun_hours(horizons, moments, 0, made.field.rows());
      const HorizonRows rows = horizons.rows(sun.azimuth, 0, made.field.rows());
      for (std::size_t i = 0; i < codes.size(); ++i) {
        if (codes[i] == Shade::hole) {
          EXPECT_TRUE(std::isnan(hours.hours[i]));
          continue;
        }
        // Heights are floats: their differences, w and their sum round by 2^-24 of the relief each, and the direction
        // moves crossings by 2^-27 cells per cell; over 10 m or more. The slope and its angle round below 2^-20.
        const double relief =
            static_cast<double>(made.field.max_height()) - static_cast<double>(made.field.min_height());
        const double room = (4 * 0x1p-24 + 0x1p-27) * relief / 10 + 0x1p-20;
        ++compared;
        if (std::abs(std::tan(static_cast<double>(rows.angle[i])) - std::tan(sun.altitude)) < room) {
          ++close;
          continue;
        }
        EXPECT_EQ(hours.hours[i] > 0, codes[i] == Shade::lit) << "shape " << s << ", sun " << a << ", node " << i;
        EXPECT_EQ(hours.first[i], codes[i] == Shade::lit ? 0 : -1);
      }
    }
  }
  EXPECT_GT(compared, 16'000 * kFieldsPerKind);
  EXPECT_LT(close, compared / 50);
}

}  // namespace
}  // namespace scarp
