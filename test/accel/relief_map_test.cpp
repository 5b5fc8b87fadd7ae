// SPDX-License-Identifier: MIT
#include "scarp/accel/relief_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

#include "scarp/accel/max_pyramid.h"

namespace scarp {
namespace {

constexpr int kBlockSide = 1 << ReliefMap::kLevel;

// The steepest edge of a block's cells, straight from the samples; nodata counts as the lowest sample.
double brute_force(const HeightField& field, int col, int row) {
  double steepest = 0;
  for (int r = row * kBlockSide; r < std::min((row + 1) * kBlockSide, field.cell_rows()); ++r) {
    for (int c = col * kBlockSide; c < std::min((col + 1) * kBlockSide, field.cell_cols()); ++c) {
      const auto sample = [&](int col_of, int row_of) {
        return field.visit([&](const auto& grid) {
          const auto there = grid.at(col_of % grid.cols, row_of % grid.rows);
          return grid.is_nodata(there) ? field.min_sample() : static_cast<double>(there);
        });
      };
      const double h00 = sample(c, r), h10 = sample(c + 1, r), h01 = sample(c, r + 1), h11 = sample(c + 1, r + 1);
      steepest =
          std::max({steepest, std::abs(h10 - h00), std::abs(h11 - h01), std::abs(h01 - h00), std::abs(h11 - h10)});
    }
  }
  return steepest;
}

void expect_tight(const HeightField& field, const ReliefMap& map) {
  ASSERT_EQ(map.cols(), (field.cell_cols() + kBlockSide - 1) / kBlockSide);
  ASSERT_EQ(map.rows(), (field.cell_rows() + kBlockSide - 1) / kBlockSide);
  for (int row = 0; row < map.rows(); ++row) {
    for (int col = 0; col < map.cols(); ++col) {
      const double truth = brute_force(field, col, row), there = static_cast<double>(map.row(row)[col]);
      ASSERT_GE(there, truth) << col << " " << row;
      if (std::isfinite(truth)) {
        ASSERT_LE(there, truth * (1 + 0x1p-20)) << col << " " << row;
      }
    }
  }
}

template <class T>
std::vector<T> rough_samples(int cols, int rows, double scale) {
  std::mt19937 random(11);
  std::vector<T> samples(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
  const double least = std::is_unsigned_v<T> ? 0 : -30000;
  for (T& s : samples) s = static_cast<T>(scale * (static_cast<double>(random() % 60000) + least));
  return samples;
}

TEST(ReliefMap, HasTheSteepestEdgeOfEachBlockAtAnySize) {
  for (const auto& [cols, rows] : {std::pair{2, 2}, {9, 9}, {8, 8}, {10, 17}, {65, 33}, {101, 97}, {3, 130}}) {
    for (const Wrap wrap : {Wrap::none, Wrap::periodic}) {
      SCOPED_TRACE(testing::Message() << cols << " x " << rows);
      const auto check = [&](const HeightField& field) {
        ReliefMap map;
        map.build(field);
        expect_tight(field, map);
      };
      check(HeightField::own(rough_samples<float>(cols, rows, 0.37), cols, rows, {.wrap = wrap}));
      check(HeightField::own(rough_samples<float>(cols, rows, 1e-44), cols, rows, {.wrap = wrap}));
      check(HeightField::own(rough_samples<std::int16_t>(cols, rows, 1), cols, rows, {.wrap = wrap}));
      check(HeightField::own(rough_samples<std::uint16_t>(cols, rows, 0.5), cols, rows, {.nodata = 77, .wrap = wrap}));
    }
  }
}

TEST(ReliefMap, TreatsNodataAsTheLowestSample) {
  auto samples = rough_samples<float>(40, 33, 1);
  samples[40 * 16 + 16] = std::numeric_limits<float>::quiet_NaN();
  const HeightField field = HeightField::own(samples, 40, 33);
  ReliefMap map;
  map.build(field);
  expect_tight(field, map);
  EXPECT_EQ(static_cast<double>(map.lowest()), field.min_sample());
}

TEST(ReliefMap, FollowsEdits) {
  std::mt19937 random(12);
  for (const Wrap wrap : {Wrap::none, Wrap::periodic}) {
    const int cols = 75, rows = 50;
    HeightField field = HeightField::own(rough_samples<float>(cols, rows, 1), cols, rows, {.wrap = wrap});
    MaxPyramid pyramid(field);
    for (int i = 0; i < 40; ++i) {
      const int col = static_cast<int>(random() % cols), row = static_cast<int>(random() % rows);
      const SampleRect rect{col, row, 1 + static_cast<int>(random() % static_cast<unsigned>(cols - col)),
                            1 + static_cast<int>(random() % static_cast<unsigned>(rows - row))};
      const bool hole = random() % 3 == 0;
      const std::vector<float> samples(
          static_cast<std::size_t>(rect.cols * rect.rows),
          hole ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(random() % 60000) - 30000);
      pyramid.update(field, field.set_samples(rect, samples.data(), rect.cols));
      if (!field.all_nodata()) expect_tight(field, pyramid.relief());
    }
  }
}

}  // namespace
}  // namespace scarp
