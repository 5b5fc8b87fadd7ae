// SPDX-License-Identifier: MIT
#include "scarp/accel/max_pyramid.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace scarp {
namespace {

template <class T>
T lowest() {
  return std::numeric_limits<T>::has_infinity ? -std::numeric_limits<T>::infinity() : std::numeric_limits<T>::lowest();
}

// The maximum over a block's cells, straight from the samples.
template <class T>
T brute_force(const SampleGrid<T>& grid, int level, int col, int row) {
  T highest = lowest<T>();
  for (int r = row << level; r < std::min((row + 1) << level, grid.rows - 1); ++r) {
    for (int c = col << level; c < std::min((col + 1) << level, grid.cols - 1); ++c) {
      if (!grid.is_hole(c, r))
        highest = std::max({highest, grid.at(c, r), grid.at(c + 1, r), grid.at(c, r + 1), grid.at(c + 1, r + 1)});
    }
  }
  return highest;
}

template <class T>
void expect_tight(const HeightField& field) {
  const MaxPyramid pyramid(field);
  field.visit([&](const auto& grid) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(grid.data[0])>, T>) {
      std::size_t entries = 0;
      for (int l = 1; l <= pyramid.top_level(); ++l) {
        const auto level = pyramid.level<T>(l);
        ASSERT_EQ(level.cols, (field.cell_cols() + (1 << l) - 1) >> l);
        ASSERT_EQ(level.rows, (field.cell_rows() + (1 << l) - 1) >> l);
        entries += static_cast<std::size_t>(level.cols) * level.rows;
        for (int row = 0; row < level.rows; ++row) {
          for (int col = 0; col < level.cols; ++col)
            ASSERT_EQ(level.at(col, row), brute_force(grid, l, col, row)) << l << ": " << col << ", " << row;
        }
      }
      EXPECT_EQ(pyramid.bytes(), entries * sizeof(T));
    }
  });
  EXPECT_EQ(pyramid.levels().back().cols, 1);
  EXPECT_EQ(pyramid.levels().back().rows, 1);
}

template <class T>
std::vector<T> noise(int cols, int rows) {
  std::mt19937 random(7);
  std::vector<T> samples(static_cast<std::size_t>(cols) * rows);
  for (T& s : samples) s = static_cast<T>(random() % 1000);
  return samples;
}

TEST(MaxPyramid, EqualsTheMaximumOfEachBlockAtAnySize) {
  for (const auto& [cols, rows] : std::vector<std::pair<int, int>>{
           {2, 2}, {2, 9}, {3, 3}, {4, 4}, {5, 17}, {16, 16}, {17, 17}, {13, 29}, {64, 3}, {65, 33}, {101, 97}}) {
    SCOPED_TRACE(std::to_string(cols) + " x " + std::to_string(rows));
    expect_tight<float>(HeightField::own(noise<float>(cols, rows), cols, rows));
    expect_tight<std::int16_t>(HeightField::own(noise<std::int16_t>(cols, rows), cols, rows));
    expect_tight<std::uint16_t>(HeightField::own(noise<std::uint16_t>(cols, rows), cols, rows));
  }
}

TEST(MaxPyramid, LeavesHolesOut) {
  auto ints = noise<std::int16_t>(21, 19);
  auto floats = noise<float>(21, 19);
  std::mt19937 random(8);
  for (int i = 0; i < 60; ++i) {
    const auto at = random() % ints.size();
    ints[at] = 9999;  // higher than all: a hole that is taken for ground would show
    floats[at] = i % 2 ? std::numeric_limits<float>::quiet_NaN() : 9999.f;
  }
  expect_tight<std::int16_t>(HeightField::own(ints, 21, 19, {.nodata = 9999}));
  expect_tight<float>(HeightField::own(floats, 21, 19, {.nodata = 9999}));
}

TEST(MaxPyramid, HasNoLevelsWithoutCells) {
  EXPECT_EQ(MaxPyramid(HeightField::own(noise<float>(5, 1), 5, 1)).top_level(), 0);
}

RC_GTEST_PROP(MaxPyramid, BoundsTheSurfaceBetweenTheSamples, ()) {
  const int cols = *rc::gen::inRange(2, 40), rows = *rc::gen::inRange(2, 40);
  const HeightField field = HeightField::own(noise<float>(cols, rows), cols, rows);
  const MaxPyramid pyramid(field);
  const double x = *rc::gen::inRange(0, 10001) * 1e-4 * field.width(),
               y = *rc::gen::inRange(0, 10001) * 1e-4 * field.depth();
  const auto place = field.place(x, y).value();
  for (int l = 1; l <= pyramid.top_level(); ++l) {
    RC_ASSERT(static_cast<double>(pyramid.level<float>(l).at(place.cell.col >> l, place.cell.row >> l)) >=
              field.height(x, y).value());
  }
}

}  // namespace
}  // namespace scarp
