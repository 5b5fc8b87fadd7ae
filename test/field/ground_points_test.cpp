// SPDX-License-Identifier: MIT
// heights_at() and ground_point(): the bytes of HeightField::height() and normal(), over all kinds of fields.
#include "scarp/field/ground_points.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "march/instruction_sets.h"

namespace scarp {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr int kHole = 77;

struct Points {
  std::vector<double> x, y;
  void add(double px, double py) { x.push_back(px), y.push_back(py); }
};

// Inside, on nodes and lines, within rounding of them, at and beyond the border, far away, not numbers.
Points points_over(const HeightField& field, std::mt19937& random) {
  const double cell_x = field.settings().cell_x, cell_y = field.settings().cell_y;
  std::uniform_real_distribution<double> along(-0.2, 1.2);
  std::uniform_int_distribution<int> col(-2, field.cols() + 1), row(-2, field.rows() + 1), ulps(-3, 3);
  const auto moved = [&](double value) {
    for (int n = ulps(random); n != 0; n += n < 0 ? 1 : -1) value = std::nextafter(value, n < 0 ? -HUGE_VAL : HUGE_VAL);
    return value;
  };
  Points points;
  for (int i = 0; i < 400; ++i) {
    points.add(along(random) * field.width(), along(random) * field.depth());
    points.add(moved(col(random) * cell_x), along(random) * field.depth());
    points.add(along(random) * field.width(), moved(row(random) * cell_y));
    points.add(moved(col(random) * cell_x), moved(row(random) * cell_y));
  }
  for (const double odd : {kNan, HUGE_VAL, -HUGE_VAL, 1e300, -1e18, -0.0, 5e-324}) {
    points.add(odd, 1), points.add(1, odd), points.add(odd, odd);
  }
  return points;
}

template <class T>
HeightField field_of(int cols, int rows, bool holes, HeightFieldSettings settings, std::mt19937& random) {
  std::uniform_int_distribution<int> sample(1, 60), hole(0, 3);
  std::vector<T> samples(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
  for (T& s : samples) s = static_cast<T>(holes && hole(random) == 0 ? kHole : sample(random));
  if (settings.wrap == Wrap::shared_border) {
    const auto at = [&](int c, int r) -> T& { return samples[static_cast<std::size_t>(r * cols + c)]; };
    for (int r = 0; r < rows; ++r) at(cols - 1, r) = at(0, r);
    for (int c = 0; c < cols; ++c) at(c, rows - 1) = at(c, 0);
  }
  if (holes) settings.nodata = kHole;
  return HeightField::own(std::move(samples), cols, rows, settings);
}

// The same bits; all NaN count as equal.
bool same(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void expect_single_answers(const HeightField& field, std::mt19937& random) {
  const Points p = points_over(field, random);
  std::vector<double> heights(p.x.size()), alone(p.x.size());
  std::vector<dvec3> normals(p.x.size());
  heights_at(field, p.x, p.y, heights, normals);
  for (const std::int64_t set : test::instruction_sets()) {
    const test::InstructionSet chosen(set);
    std::vector<double> in_set(p.x.size());
    std::vector<dvec3> normals_in_set(p.x.size());
    heights_at(field, p.x, p.y, in_set, normals_in_set);
    heights_at(field, p.x, p.y, alone);
    for (std::size_t i = 0; i < p.x.size(); ++i) {
      ASSERT_TRUE(same(in_set[i], heights[i]) && same(alone[i], heights[i])) << set;
      ASSERT_EQ(normals_in_set[i], normals[i]) << set;
    }
  }
  int ground = 0;
  for (std::size_t i = 0; i < p.x.size(); ++i) {
    const std::string where = std::to_string(p.x[i]) + ", " + std::to_string(p.y[i]);
    const auto place = field.place(p.x[i], p.y[i]);
    const auto height = field.height(p.x[i], p.y[i]);
    const auto point = ground_point(field, p.x[i], p.y[i]);
    if (std::isinf(p.x[i]) || std::isinf(p.y[i])) {
      ASSERT_FALSE(height) << where;
    }
    ASSERT_TRUE(same(heights[i], height.value_or(kNan))) << where << ": " << heights[i];
    ASSERT_EQ(point.has_value(), height.has_value()) << where;
    const dvec3 normal = height ? field.normal(place->cell, place->u, place->v) : dvec3(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_TRUE(same(normals[i][axis], normal[axis])) << where;
      if (point) {
        ASSERT_TRUE(same(point->normal[axis], normal[axis])) << where;
      }
    }
    if (!height) continue;
    ++ground;
    ASSERT_TRUE(same(point->height, *height)) << where;
    // The height of the cell, by the corners that the place names.
    const auto h = field.cell_heights(place->cell);
    ASSERT_TRUE(h) << where;
    ASSERT_EQ(*height, field.height_from_sample(height_in_cell(field.settings().surface, *h, place->u, place->v)))
        << where;
  }
  if (field.has_ground()) {
    EXPECT_GT(ground, 0);
  }
}

template <class T>
void expect_single_answers_of_type() {
  std::mt19937 random(5);
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    for (const Wrap wrap : {Wrap::none, Wrap::periodic, Wrap::shared_border}) {
      for (const bool holes : {false, true}) {
        for (const auto& [cols, rows] : {std::pair(33, 21), {2, 2}, {3, 40}, {9, 1}}) {
          SCOPED_TRACE(std::to_string(static_cast<int>(surface)) + " " + std::to_string(static_cast<int>(wrap)) + " " +
                       std::to_string(holes) + " " + std::to_string(cols) + " x " + std::to_string(rows));
          HeightFieldSettings settings{.cell_x = 0.3, .cell_y = 7.1, .scale = 0.7, .offset = -3, .exaggeration = 1.3};
          settings.surface = surface, settings.wrap = wrap;
          expect_single_answers(field_of<T>(cols, rows, holes, settings, random), random);
          if (testing::Test::HasFatalFailure()) return;
        }
      }
    }
  }
}

TEST(GroundPoints, EqualSinglePointsInt16) { expect_single_answers_of_type<std::int16_t>(); }
TEST(GroundPoints, EqualSinglePointsUint16) { expect_single_answers_of_type<std::uint16_t>(); }
TEST(GroundPoints, EqualSinglePointsFloat32) { expect_single_answers_of_type<float>(); }

// Rows from south to north in memory.
TEST(GroundPoints, EqualSinglePointsWithANegativeStride) {
  std::mt19937 random(6);
  std::vector<float> samples(40 * 30);
  for (float& s : samples) s = static_cast<float>(random() % 100);
  expect_single_answers(HeightField::view(samples.data() + 29 * 40, 40, 30, {.cell_x = 2}, -40), random);
}

}  // namespace
}  // namespace scarp
