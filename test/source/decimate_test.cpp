// SPDX-License-Identifier: MIT
#include "scarp/source/raster/decimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace scarp {
namespace {

// Adds all samples in pieces of odd sizes, in bands of rows.
template <class T>
std::vector<T> decimated(const std::vector<T>& samples, int cols, int rows, int out_cols, int out_rows,
                         std::optional<T> nodata, int piece_cols, int piece_rows, const SampleEnds& known = {}) {
  Decimator<T> decimator(cols, rows, out_cols, out_rows, nodata);
  for (int row = 0; row < rows; row += piece_rows) {
    for (int col = 0; col < cols; col += piece_cols) {
      const RasterWindow rect{col, row, std::min(piece_cols, cols - col), std::min(piece_rows, rows - row)};
      std::vector<T> piece;
      for (int r = rect.row; r < rect.row + rect.rows; ++r) {
        const auto line = samples.begin() + r * cols + col;
        piece.insert(piece.end(), line, line + rect.cols);
      }
      decimator.add(rect, piece.data());
    }
    decimator.close_rows(std::min(row + piece_rows, rows));
  }
  return decimator.finish(known);
}

TEST(Decimate, ChoosesTheSmallestBlockWithinTheLimit) {
  const DecimatedSize square = decimated_size(16384, 16384, 16'000'000);
  EXPECT_EQ(5, square.block);
  EXPECT_EQ(3277, square.cols);
  EXPECT_EQ(3277, square.rows);
  EXPECT_EQ(1, decimated_size(4000, 4000, 16'000'000).block);
  const DecimatedSize strip = decimated_size(2, 2'000'000'000, 16'000'000);
  EXPECT_EQ(2, strip.cols);
  EXPECT_EQ(250, strip.block);
  EXPECT_EQ(1, decimated_size(2'147'483'647, 1, 16'000'000).rows);
}

// Pieces may end anywhere; blocks that differ by a column or row still cover every sample once.
TEST(Decimate, AveragesBlocksInAnyReadingOrder) {
  std::mt19937 random(7);
  constexpr int kCols = 1531, kRows = 47, kOutCols = 219, kOutRows = 8;
  std::vector<std::int16_t> samples;
  for (int i = 0; i < kCols * kRows; ++i) samples.push_back(static_cast<std::int16_t>(random() % 60001 - 30000));
  const auto low = *std::min_element(samples.begin(), samples.end()),
             high = *std::max_element(samples.begin(), samples.end());
  for (const auto& [piece_cols, piece_rows] : {std::pair(kCols, kRows), {kCols, 1}, {100, 9}, {1, 5}}) {
    const auto out = decimated<std::int16_t>(samples, kCols, kRows, kOutCols, kOutRows, {}, piece_cols, piece_rows);
    int changed = 0;
    for (int row = 0; row < kOutRows; ++row) {
      for (int col = 0; col < kOutCols; ++col) {
        double sum = 0, count = 0;
        for (int r = row * kRows / kOutRows; r < (row + 1) * kRows / kOutRows; ++r) {
          for (int c = col * kCols / kOutCols; c < (col + 1) * kCols / kOutCols; ++c, ++count)
            sum += samples[static_cast<std::size_t>(r * kCols + c)];
        }
        changed += std::lround(sum / count) != out[static_cast<std::size_t>(row * kOutCols + col)];
      }
    }
    EXPECT_EQ(2, changed) << "the blocks of the extremes alone";
    EXPECT_EQ(low, *std::min_element(out.begin(), out.end()));
    EXPECT_EQ(high, *std::max_element(out.begin(), out.end()));
  }
}

TEST(Decimate, MarksBlocksLessThanHalfValidAsHoles) {
  constexpr float kHole = -9999, kNan = std::numeric_limits<float>::quiet_NaN();
  // Blocks of 2 x 2: half valid, a quarter, all, a quarter with the maximum, half with the minimum, none.
  const std::vector<float> samples{1,     3,    kHole, 4,     5, 6, 90,    kHole, -7,    kNan, kHole, kNan,  //
                                   kHole, kNan, kHole, kHole, 7, 8, kHole, kHole, kHole, 1,    kHole, kHole};
  const auto out = decimated<float>(samples, 12, 2, 6, 1, kHole, 5, 1);
  EXPECT_EQ((std::vector<float>{2, kHole, 6.5f, 90, -7, kHole}), out);
}

TEST(Decimate, AveragesNeverEqualNodata) {
  EXPECT_EQ((std::vector<std::int16_t>{1, -5, 5}),
            decimated<std::int16_t>({-1, 1, -5, -5, 5, 5}, 6, 1, 3, 1, std::int16_t{0}, 6, 1));
}

TEST(Decimate, KeepsBothExtremesOfOneBlock) {
  EXPECT_EQ((std::vector<float>{0, -50, 80}), decimated<float>({0, 0, 1, 3, 80, -50}, 6, 1, 3, 1, {}, 6, 1));
  EXPECT_EQ((std::vector<float>{80}), decimated<float>({80, -50}, 2, 1, 1, 1, {}, 2, 1));
}

TEST(Decimate, KnownExtremesReplaceMeasuredOnes) {
  EXPECT_EQ((std::vector<float>{-10, 3, 6}), decimated<float>({1, 1, 3, 3, 5, 5}, 6, 1, 3, 1, {}, 6, 1, {-10, 6}));
  // Statistics with a narrower range than the samples are wrong.
  EXPECT_EQ((std::vector<float>{1, 3, 5}), decimated<float>({1, 1, 3, 3, 5, 5}, 6, 1, 3, 1, {}, 6, 1, {2, 4}));
}

TEST(Decimate, UnreadRowsAreHoles) {
  Decimator<std::uint16_t> decimator(4, 4, 2, 2, std::uint16_t{9});
  decimator.close_rows(2);
  const std::uint16_t samples[] = {1, 1, 4, 4, 1, 1, 4, 4};
  decimator.add({0, 2, 4, 2}, samples);
  decimator.close_rows(4);
  EXPECT_EQ((std::vector<std::uint16_t>{9, 9, 1, 4}), decimator.finish());
}

}  // namespace
}  // namespace scarp
