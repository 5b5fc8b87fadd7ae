// SPDX-License-Identifier: MIT
// Shadows and lines of sight over bilinear ground against dense samples of every ray.
#include "scarp/analysis/bilinear_ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "analysis/map_fields.h"
#include "cases.h"
#include "scarp/base/error.h"

namespace scarp::test {
namespace {

// Least clearance of a ray over bilinear ground, from 64 samples per cell. The start does not count.
double dense_clearance(const HeightField& field, double col, double row, double cols, double rows, double z, double dz,
                       double length, bool with_end = false) {
  double least = std::numeric_limits<double>::infinity();
  const double step = 1 / (64 * std::max(std::abs(cols), std::abs(rows)));
  for (double t = step; t < length + (with_end ? 0.5 : -0.5) * step; t += step) {
    const double c = col + t * cols, r = row + t * rows;
    const double x = c * field.settings().cell_x, y = (field.rows() - 1 - r) * field.settings().cell_y;
    if (c < 0 || r < 0 || c > field.cols() - 1 || r > field.rows() - 1) break;
    if (const auto ground = field.height(x, y)) least = std::min(least, z + t * dz - *ground);
  }
  return least;
}

// Tolerance of sampling: a ray may dip between samples, and starts on the ground.
constexpr double kRounding = 1e-6;
double between_samples(const HeightField& field) { return kRounding + (field.max_height() - field.min_height()) / 100; }

TEST(BilinearGround, ShadowsMatchDenseSamples) {
  int counts[4] = {};
  std::size_t turn = 0;
  const auto suns = map_suns();
  const auto fields = map_fields();
  for (std::size_t k = 0; k < fields.size(); k += static_cast<std::size_t>(cases(1, 3, 8))) {
    const HeightField& field = fields[k].field;
    if (!field.has_cells()) continue;
    const BilinearGround ground(field);
    for (int i = 0; i < 3; ++i) {
      const SunRay sun = sun_ray(field, suns[turn++ % suns.size()]);
      // Cells per unit of t.
      const auto unit = static_cast<double>(SunRay::kUnit);
      const double cols = static_cast<double>(sun.col) / unit, rows = static_cast<double>(sun.row) / unit;
      if ((cols == 0 || rows == 0) && field.nodata_count() > 0) continue;  // along lines beside holes
      const SightGround heights(field);
      for (int row = 0; row < field.rows(); ++row)
        for (int col = 0; col < field.cols(); ++col) {
          const Shade shade = ground.shade(sun, {col, row});
          ++counts[static_cast<int>(shade)];
          const auto height = heights.height({col, row});
          ASSERT_EQ(shade == Shade::hole, !height);
          if (!height) continue;
          const double rise = sun.rise / unit;
          const auto least = [&](double length) {
            return dense_clearance(field, col, row, cols, rows, *height, rise, length, true);
          };
          const double clearance = least(100), at_first = least(1);
          const bool dark = shade != Shade::lit;
          const auto where = [&] {
            return testing::Message() << fields[k].name << ", column " << col << ", row " << row << ", sun " << cols
                                      << ", " << rows << ": " << clearance;
          };
          if (clearance < -kRounding) {
            EXPECT_TRUE(dark) << where();
          }
          if (clearance > between_samples(field)) {
            EXPECT_FALSE(dark) << where();
          }
          if (dark && at_first > between_samples(field)) {
            EXPECT_EQ(shade, Shade::cast_shadow) << where();
          }
          // A hole beside the node does not face away.
          if (field.nodata_count() == 0 && at_first < -between_samples(field)) {
            EXPECT_EQ(shade, Shade::self_shaded) << where();
          }
        }
    }
  }
  for (const int count : counts) EXPECT_GT(count, cases(100, 100, 10));
}

TEST(BilinearGround, LinesOfSightMatchDenseSamples) {
  std::mt19937 random(5);
  int visible = 0, hidden = 0;
  for (const MapField& kind : map_fields()) {
    const HeightField& field = kind.field;
    if (!field.has_cells()) continue;
    const BilinearGround ground(field);
    const auto place = [&](int nodes) {
      const auto last = static_cast<unsigned>(nodes - 1);
      return random() % 3 == 0 ? static_cast<double>(random() % (last + 1))
                               : static_cast<double>(random() % (last * kSubcells)) / kSubcells;
    };
    for (int i = 0; i < cases(30, 10, 3); ++i) {
      const auto end = [&] {
        return SightEnd{place(field.cols()), place(field.rows()), static_cast<double>(random() % 4)};
      };
      const SightEnd from = end(), to = end();
      LineOfSight line, back;
      try {
        line = ground.line_of_sight(from, to);
        back = ground.line_of_sight(to, from);
      } catch (const Error&) {
        continue;  // an end on a hole
      }
      (line.visible ? visible : hidden) += 1;
      const double cols = to.col - from.col, rows = to.row - from.row;
      const double clearance =
          dense_clearance(field, from.col, from.row, cols, rows, line.eye, line.target - line.eye, 1);
      const auto where = [&] {
        return testing::Message() << kind.name << ", " << from.col << ", " << from.row << " to " << to.col << ", "
                                  << to.row << ": " << clearance;
      };
      if (clearance < -kRounding) {
        EXPECT_FALSE(line.visible) << where();
      }
      if (clearance > between_samples(field)) {
        EXPECT_TRUE(line.visible) << where();
      }
      EXPECT_EQ(line.visible, back.visible) << where();
      // Samples next to the ends do not count as clearances.
      if (clearance < -kRounding) {
        EXPECT_LT(line.clearance, clearance + kRounding) << where();
      }
      if (std::isfinite(clearance)) {
        EXPECT_GT(line.clearance, clearance - between_samples(field)) << where();
      }
      if (!line.obstruction) continue;
      EXPECT_LT(line.clearance, 0) << where();
      const double at = line.obstruction->along;
      EXPECT_NEAR(line.obstruction->height, line.eye + at * (line.target - line.eye), kRounding) << where();
      EXPECT_GT(dense_clearance(field, from.col, from.row, cols, rows, line.eye, line.target - line.eye, at),
                -kRounding)
          << where();
    }
  }
  EXPECT_GT(visible, cases(100, 100, 10));
  EXPECT_GT(hidden, cases(100, 100, 10));
}

// Within a cell whose opposite corners are high, the ground between two low corners rises to the mean of all four.
TEST(BilinearGround, AccountsForGroundBetweenCrossings) {
  const auto field = HeightField::own(std::vector<float>{0, 10, 10, 0}, 2, 2, {.cell_x = 3, .cell_y = 4});
  const BilinearGround ground(field);
  EXPECT_TRUE(line_of_sight(field, {0, 0, 4}, {1, 1, 4}, {.coefficient = 0}).visible);
  const auto low = ground.line_of_sight({0, 0, 4}, {1, 1, 4});
  ASSERT_FALSE(low.visible);
  // Numbers up to 20, and a root whose derivative is below 1 there: some tens of roundings.
  constexpr double kRoundings = 20 * 0x1p-47;
  EXPECT_NEAR(low.clearance, -1, kRoundings);
  EXPECT_NEAR(low.clearance_along, 0.5, kRoundings);
  EXPECT_NEAR(low.obstruction->along, 0.5 - std::sqrt(0.05), kRoundings);  // 20 t (1 - t) = 4
  EXPECT_NEAR(low.obstruction->height, 4, kRoundings);
  const auto high = ground.line_of_sight({0, 0, 5.5}, {1, 1, 5.5});
  EXPECT_TRUE(high.visible);
  EXPECT_NEAR(high.clearance, 0.5, kRoundings);
}

TEST(BilinearGround, GrazingIsVisible) {
  std::vector<float> heights(9 * 9, 0);
  for (int row = 0; row < 9; ++row) heights[static_cast<std::size_t>(row * 9 + 4)] = 10;
  const auto field = HeightField::own(std::move(heights), 9, 9);
  const BilinearGround ground(field);
  for (const double row : {2.0, 2.5}) {
    EXPECT_TRUE(ground.line_of_sight({0, row, 10}, {8, row, 10}).visible);
    EXPECT_FALSE(ground.line_of_sight({0, row, 10}, {8, row, 9.999}).visible);
    EXPECT_TRUE(ground.line_of_sight({0, row}, {3, row}).visible);     // along the ground
    EXPECT_TRUE(ground.line_of_sight({0, row, 5}, {4, row}).visible);  // up to the crest
    EXPECT_FALSE(ground.line_of_sight({0, row, 5}, {4.5, row}).visible);
    EXPECT_TRUE(ground.line_of_sight({2, row, 5}, {2, row, 1}).visible);  // straight down
  }
  EXPECT_EQ(ground.shade({SunRay::kUnit, 0, SunRay::kUnit * 10. / 3}, {1, 4}), Shade::lit);  // over the crest
  EXPECT_EQ(ground.shade({SunRay::kUnit, 0, SunRay::kUnit * 9.9 / 3}, {1, 4}), Shade::cast_shadow);
  EXPECT_EQ(ground.shade({SunRay::kUnit, 0, SunRay::kUnit * 9.}, {3, 4}), Shade::self_shaded);
}

TEST(BilinearGround, RejectsFieldsWithoutCells) {
  EXPECT_THROW(BilinearGround(HeightField::own(std::vector<float>{1, 2, 3}, 3, 1)), Error);
  EXPECT_THROW(BilinearGround(HeightField::own(std::vector<float>(9, 1), 3, 3, {.wrap = Wrap::periodic})), Error);
}

}  // namespace
}  // namespace scarp::test
