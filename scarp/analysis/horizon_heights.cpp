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

}  // namespace

HorizonHeights::HorizonHeights(const HeightField& field, int sign, bool transposed)
    : cols_(transposed ? field.rows() : field.cols()),
      rows_(transposed ? field.cols() : field.rows()),
      sign_(sign),
      tallest_(field.all_nodata() ? 0 : std::max(std::abs(field.min_height()), std::abs(field.max_height()))),
      pitch_(odd_lines(cols_ + 2 * kMargin)),
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

}  // namespace scarp
