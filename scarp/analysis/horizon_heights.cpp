// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/base/parallel.h"

namespace scarp {
namespace {

constexpr std::int64_t kTileSide = 64;

// An odd number of cache lines: rows at a power of two would share the same sets of the cache.
std::ptrdiff_t odd_lines(std::ptrdiff_t samples) {
  constexpr std::ptrdiff_t kLine = 16;
  return ((samples + kLine - 1) / kLine | 1) * kLine;
}

std::ptrdiff_t whole_pitch_of(int cols) { return odd_lines(cols + 2 * HorizonHeights::kMargin); }

}  // namespace

double tallest_of(const HeightField& field) {
  return field.all_nodata() ? 0 : std::max(std::abs(field.min_height()), std::abs(field.max_height()));
}

HorizonHeights::HorizonHeights(const HeightField& field, int sign, bool transposed)
    : cols_(transposed ? field.rows() : field.cols()),
      rows_(transposed ? field.cols() : field.rows()),
      sign_(sign),
      tallest_(tallest_of(field)),
      pitch_(whole_pitch_of(cols_)),
      whole_pitch_(pitch_),
      origin_(kMargin * pitch_ + kMargin),
      values_(static_cast<std::size_t>(pitch_ * (rows_ + 2 * kMargin)), std::numeric_limits<float>::quiet_NaN()) {
  field.visit([&](const auto& grid) {
    // Tiles of the field's rows and columns: the transpose then stays within the cache.
    parallel_for(rows_, kTileSide, [&](std::int64_t begin, std::int64_t end) {
      for (int first = 0; first < cols_; first += static_cast<int>(kTileSide)) {
        const int last = std::min(first + static_cast<int>(kTileSide), cols_);
        for (int row = static_cast<int>(begin); row < end; ++row) {
          float* to = &values_[place(0, row)];
          for (int col = first; col < last; ++col) {
            const auto sample = transposed ? grid.at(row, col) : grid.at(col, row);
            if (!(grid.has_holes && grid.is_nodata(sample)))
              to[col] = static_cast<float>(sign * field.height_from_sample(static_cast<double>(sample)));
          }
        }
      }
    });
  });
}

HorizonLayout HorizonHeights::layout_of(const HorizonTiles& tiles, const StripShape& shape, bool transposed) {
  const int cols = transposed ? tiles.rows() : tiles.cols(), rows = transposed ? tiles.cols() : tiles.rows();
  return {cols, rows, tiles.sign(), shape.pitch(), whole_pitch_of(cols)};
}

HorizonHeights::HorizonHeights(const HorizonTiles& tiles, const StripShape& shape, double offset, bool transposed,
                               LargeVector<float> memory)
    : cols_(transposed ? tiles.rows() : tiles.cols()),
      rows_(transposed ? tiles.cols() : tiles.rows()),
      sign_(tiles.sign()),
      tallest_(tiles.tallest()),
      pitch_(shape.pitch()),
      whole_pitch_(whole_pitch_of(cols_)),
      origin_(shape.origin(offset)),
      values_(std::move(memory)) {
  values_.assign(shape.samples(offset), std::numeric_limits<float>::quiet_NaN());
  constexpr int kSide = HorizonTiles::kSide;
  float tile[HorizonTiles::kSamples];
  const int first_row = std::max(shape.row_begin(offset), 0), end_row = std::min(shape.row_end(offset), rows_);
  for (int down = first_row / kSide; down * kSide < end_row; ++down) {
    // The strip's columns in each row of tiles.
    int begin[kSide], end[kSide], least = cols_, most = 0;
    for (int r = 0; r < kSide; ++r) {
      const int row = down * kSide + r;
      begin[r] = end[r] = 0;
      if (row < first_row || row >= end_row) continue;
      begin[r] = std::max(shape.col_begin(offset, row), 0), end[r] = std::min(shape.col_end(offset, row), cols_);
      if (begin[r] < end[r]) least = std::min(least, begin[r]), most = std::max(most, end[r]);
    }
    for (int col = least / kSide * kSide; col < most; col += kSide) {
      bool is_read = false;
      for (int r = 0; r < kSide; ++r) {
        const int from = std::max(begin[r], col), to = std::min(end[r], col + kSide);
        if (from >= to) continue;
        if (!is_read && transposed) tiles.read_transposed(col / kSide, down, tile);
        if (!is_read && !transposed) tiles.read(col / kSide, down, tile);
        is_read = true;
        std::copy(tile + r * kSide + (from - col), tile + r * kSide + (to - col),
                  &values_[place(from, down * kSide + r)]);
      }
    }
  }
}

}  // namespace scarp
