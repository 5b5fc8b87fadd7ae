// SPDX-License-Identifier: MIT
#include "scarp/accel/block_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "scarp/accel/max_pyramid.h"

namespace scarp {
namespace {

using Samples = std::vector<double>;

template <class T>
HeightField field_of(const Samples& heights, int cols, int rows, const HeightFieldSettings& settings = {}) {
  std::vector<T> samples;
  for (const double h : heights) samples.push_back(static_cast<T>(h));
  return HeightField::own(std::move(samples), cols, rows, settings);
}

// Height of a block's plane at a corner of a cell, in sample units.
double plane_at(const MaxPyramid& pyramid, int level, int col, int row, int x, int y) {
  const PyramidLevel& at = pyramid.levels()[static_cast<std::size_t>(level - 1)];
  const double half = std::ldexp(1, level - 1);
  const double from_middle_x = x - ((col << level) + half), from_middle_y = y - ((row << level) + half);
  const std::uint32_t block = pyramid.blocks()[at.begin + static_cast<std::ptrdiff_t>(row) * at.cols + col];
  return pyramid.planes().height(block, level, from_middle_x, from_middle_y);
}

// Expects that no plane is below a sample. Returns the mean height of the planes above the samples.
double expect_above(const HeightField& field, const MaxPyramid& pyramid, int level) {
  const PyramidLevel& at = pyramid.levels()[static_cast<std::size_t>(level - 1)];
  double sum = 0;
  for (int row = 0; row < field.cell_rows(); ++row) {
    for (int col = 0; col < field.cell_cols(); ++col) {
      const CellHeights h = field.cell_heights({col, row}).value();
      const double corners[] = {h.h00, h.h10, h.h01, h.h11};
      for (int i = 0; i < 4; ++i) {
        const double plane = plane_at(pyramid, level, col >> level, row >> level, col + i % 2, row + i / 2);
        EXPECT_GE(plane, corners[i]) << "level " << level << ", cell " << col << ", " << row << ", corner " << i;
        sum += plane - corners[i];
      }
    }
  }
  EXPECT_EQ(at.cols, (field.cell_cols() + (1 << level) - 1) >> level);
  return sum / (4.0 * field.cell_cols() * field.cell_rows());
}
void expect_above(const HeightField& field, const MaxPyramid& pyramid) {
  ASSERT_TRUE(pyramid.planes().exist());
  for (int level = 1; level <= pyramid.top_level(); ++level) expect_above(field, pyramid, level);
}

Samples noise(int cols, int rows, double scale) {
  std::mt19937 random(7);
  Samples heights(static_cast<std::size_t>(cols) * rows);
  for (double& h : heights) h = scale * static_cast<double>(random() % 1000);
  return heights;
}
Samples slope(int cols, int rows, double east, double south) {
  Samples heights;
  for (int row = 0; row < rows; ++row)
    for (int col = 0; col < cols; ++col) heights.push_back(std::round(east * col + south * row));
  return heights;
}

TEST(BlockPlanes, BoundTheGroundAtAnySize) {
  const std::vector<std::pair<int, int>> sizes{{2, 2}, {2, 9}, {3, 3}, {5, 17}, {17, 17}, {13, 29}, {64, 3}, {101, 97}};
  for (const auto& [cols, rows] : sizes) {
    for (const Wrap wrap : {Wrap::none, Wrap::periodic}) {
      SCOPED_TRACE(testing::Message() << cols << " x " << rows << (wrap == Wrap::none ? "" : ", wrapped"));
      for (const Samples& heights : {noise(cols, rows, 1), slope(cols, rows, 30, -17), slope(cols, rows, -3, 250)}) {
        const auto check = [](const HeightField& field) { expect_above(field, MaxPyramid(field)); };
        check(field_of<float>(heights, cols, rows, {.wrap = wrap}));
        check(field_of<std::int16_t>(heights, cols, rows, {.wrap = wrap}));
      }
    }
  }
}

TEST(BlockPlanes, BoundHeightsOfAnyMagnitude) {
  for (const double offset : {0.0, 1e6, -3e30}) {
    for (const double scale : {0.0, 1e-7, 1.0 / 3, 1e30}) {
      Samples heights = noise(33, 18, scale);
      for (double& h : heights) h += offset;
      const HeightField field = field_of<float>(heights, 33, 18);
      expect_above(field, MaxPyramid(field));
    }
  }
}

// A single cliff of the full range on gentle ground: slopes cannot follow it, and it must not spoil the rest.
TEST(BlockPlanes, StayTightOnGentleGroundBesideACliff) {
  Samples heights = slope(257, 257, 2, 1);
  heights[20 * 257 + 40] = 20000;
  const HeightField field = field_of<float>(heights, 257, 257);
  const MaxPyramid pyramid(field);
  expect_above(field, pyramid);
  // Mean over the blocks: 2 x 2 cells rise by 6; four blocks contain the cliff.
  const double mean = 6 + 4 * 20000 / (128.0 * 128), step = pyramid.planes().code().step;
  EXPECT_LT(pyramid.planes().steepest() * step, mean + 2 * step);
}

// Planes follow a slope, while maxima cannot. On each level, slopes are rounded by at most half a step, over half the
// block along both axes, the depth by one step, and codes by less than two steps.
TEST(BlockPlanes, FollowASlope) {
  for (const auto& [east, south] : {std::pair{40.0, 0.0}, {0.0, -40.0}, {31.0, 17.0}, {-25.0, 38.0}}) {
    const HeightField field = field_of<float>(slope(129, 129, east, south), 129, 129);
    const MaxPyramid pyramid(field);
    const BlockPlanes& planes = pyramid.planes();
    for (int level = 1; level <= 5; ++level) {
      const double half = std::ldexp(1, level - 1), step = planes.code().step, unit = planes.unit() * step;
      const double per_level = unit * half * (0.5 + 0.5 + BlockPlanes::kDepthUnits) + 2 * step;
      EXPECT_LT(expect_above(field, pyramid, level), level * per_level) << level;
    }
  }
}

TEST(BlockPlanes, FollowEdits) {
  std::mt19937 random(9);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (const Wrap wrap : {Wrap::none, Wrap::periodic}) {
    const int cols = 37, rows = 29;
    HeightField field = field_of<std::int16_t>(noise(cols, rows, 1), cols, rows, {.wrap = wrap});
    MaxPyramid pyramid(field);
    for (int i = 0; i < 60; ++i) {
      SampleRect rect{below(cols), below(rows), 1, 1};
      rect.cols = 1 + below(cols - rect.col), rect.rows = 1 + below(rows - rect.row);
      // Every tenth edit is higher than all before, every seventh lower.
      std::vector<std::int16_t> edit(static_cast<std::size_t>(rect.cols) * rect.rows);
      for (auto& sample : edit)
        sample = static_cast<std::int16_t>(below(1000) + (i % 10 == 9 ? 300 * i : i % 7 == 6 ? -400 * i : 0));
      pyramid.update(field, field.set_samples(rect, edit.data(), rect.cols));
      expect_above(field, pyramid);
      if (HasFailure()) return;
    }
  }
}

// Otherwise one edit would refit all planes.
TEST(BlockPlanes, LeaveHeadroomForEdits) {
  for (const double height : {0.0, 1.0, 20.0}) {
    HeightField field = field_of<std::int16_t>(noise(20, 20, height), 20, 20);
    MaxPyramid pyramid(field);
    const double low = field.min_sample(), high = field.max_sample(), base = pyramid.planes().code().base;
    for (const double sample : {low - (high - low) / 8 - 1, high + (high - low) / 8 + 1}) {
      const auto edit = static_cast<std::int16_t>(sample);
      pyramid.update(field, field.set_samples({5, 5, 1, 1}, &edit, 1));
      EXPECT_EQ(pyramid.planes().code().base, base) << height;
      expect_above(field, pyramid);
    }
  }
}

TEST(BlockPlanes, DisappearAndReturnWithHoles) {
  HeightField field = field_of<std::int16_t>(noise(20, 20, 1), 20, 20, {.nodata = -1});
  MaxPyramid pyramid(field);
  ASSERT_TRUE(pyramid.planes().exist());
  std::int16_t sample = -1;
  pyramid.update(field, field.set_samples({5, 5, 1, 1}, &sample, 1));
  EXPECT_FALSE(pyramid.planes().exist());
  sample = 3;
  pyramid.update(field, field.set_samples({5, 5, 1, 1}, &sample, 1));
  expect_above(field, pyramid);
}

}  // namespace
}  // namespace scarp
