// SPDX-License-Identifier: MIT
#include "scarp/analysis/block_maxima.h"

#include <algorithm>
#include <limits>

#include "scarp/base/parallel.h"

namespace scarp {
namespace {

// Writes the maximum of each column over rows [begin, end); `none` for holes alone.
template <class T>
void column_maxima(const SampleGrid<T>& grid, int begin, int end, T none, T* out) {
  std::fill(out, out + grid.cols, none);
  for (int r = begin; r < end; ++r) {
    const T* row = grid.row(r);
    if (grid.has_holes) {
      for (int c = 0; c < grid.cols; ++c) out[c] = !grid.is_nodata(row[c]) && row[c] > out[c] ? row[c] : out[c];
    } else {
      for (int c = 0; c < grid.cols; ++c) out[c] = row[c] > out[c] ? row[c] : out[c];
    }
  }
}

}  // namespace

BlockMaxima::BlockMaxima(const HeightField& field)
    : cols_((field.cols() + kSide - 1) / kSide),
      maxima_(static_cast<std::size_t>(cols_) * static_cast<std::size_t>((field.rows() + kSide - 1) / kSide)) {
  field.visit([&]<class T>(const SampleGrid<T>& grid) {
    // Integers have no -infinity: a block of holes alone then counts as its type's lowest value.
    const T none =
        std::numeric_limits<T>::has_infinity ? -std::numeric_limits<T>::infinity() : std::numeric_limits<T>::lowest();
    parallel_for((grid.rows + kSide - 1) / kSide, 4, [&](std::int64_t first, std::int64_t last) {
      std::vector<T> columns(static_cast<std::size_t>(grid.cols));
      for (int b = static_cast<int>(first); b < last; ++b) {
        column_maxima(grid, std::max(b * kSide - 1, 0), std::min((b + 1) * kSide + 1, grid.rows), none, columns.data());
        for (int c = 0; c < cols_; ++c) {
          const auto begin = columns.begin() + std::max(c * kSide - 1, 0);
          const auto end = columns.begin() + std::min((c + 1) * kSide + 1, grid.cols);
          maxima_[static_cast<std::size_t>(b) * static_cast<std::size_t>(cols_) + static_cast<std::size_t>(c)] =
              field.height_from_sample(static_cast<double>(*std::max_element(begin, end)));
        }
      }
    });
  });
}

}  // namespace scarp
