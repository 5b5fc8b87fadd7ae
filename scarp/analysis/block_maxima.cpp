// SPDX-License-Identifier: MIT
#include "scarp/analysis/block_maxima.h"

#include <algorithm>
#include <limits>

#include "scarp/base/parallel.h"

namespace scarp {
namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();

int blocks(int samples, int side) { return (samples + side - 1) / side; }

// Writes the maximum of each column over rows [begin, end); `none` if all are holes.
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

BlockMaxima::BlockMaxima(const HeightField& field) {
  const int rows = blocks(field.rows(), kSide), cols = blocks(field.cols(), kSide);
  fine_ = {cols, std::vector<double>(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows))};
  field.visit([&]<class T>(const SampleGrid<T>& grid) {
    // Integers have no -infinity, so a block with only holes counts as the lowest value of its type.
    const T none =
        std::numeric_limits<T>::has_infinity ? -std::numeric_limits<T>::infinity() : std::numeric_limits<T>::lowest();
    parallel_for(rows, 4, [&](std::int64_t first, std::int64_t last) {
      std::vector<T> columns(static_cast<std::size_t>(grid.cols));
      auto to = fine_.maxima.begin() + first * cols;
      for (int b = static_cast<int>(first); b < last; ++b) {
        column_maxima(grid, std::max(b * kSide - 1, 0), std::min((b + 1) * kSide + 1, grid.rows), none, columns.data());
        for (int c = 0; c < cols; ++c) {
          const auto begin = columns.begin() + std::max(c * kSide - 1, 0);
          const auto end = columns.begin() + std::min((c + 1) * kSide + 1, grid.cols);
          *to++ = field.height_from_sample(static_cast<double>(*std::max_element(begin, end)));
        }
      }
    });
  });
  constexpr int kRatio = kCoarse / kSide;
  coarse_.cols = blocks(cols, kRatio);
  coarse_.maxima.assign(static_cast<std::size_t>(coarse_.cols) * static_cast<std::size_t>(blocks(rows, kRatio)), kNone);
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      double& most = coarse_.maxima[static_cast<std::size_t>(row / kRatio) * static_cast<std::size_t>(coarse_.cols) +
                                    static_cast<std::size_t>(col / kRatio)];
      most = std::max(most, fine_.at(col, row));
    }
  }
}

double BlockMaxima::highest(int side, int col, int row, int col_end, int row_end) const {
  const Level& level = side == kSide ? fine_ : coarse_;
  double most = kNone;
  for (int r = row / side; r <= row_end / side; ++r) {
    for (int c = col / side; c <= col_end / side; ++c) most = std::max(most, level.at(c, r));
  }
  return most;
}

}  // namespace scarp
