// SPDX-License-Identifier: MIT
#include "scarp/accel/relief_map.h"

#include <algorithm>
#include <cmath>

#include "scarp/accel/pyramid_levels.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

constexpr int kSide = 1 << ReliefMap::kLevel;

// The difference of two samples is rounded once, and so is this product: together less than 2^-22. Differences below
// the smallest normal float are exact.
float rounded_up(float steepest) { return steepest * (1 + 0x1p-22f); }

// Adds one row of samples to the steepest edges so far: the edges from columns [begin, begin + count) to the next
// column.
template <class T>
void add_along(const T* row, int begin, int plain, int count, float* steepest) {
  const T* samples = row + begin;
  for (int i = 0; i < plain; ++i) {
    const float rise = std::abs(static_cast<float>(samples[i + 1]) - static_cast<float>(samples[i]));
    steepest[i] = rise > steepest[i] ? rise : steepest[i];
  }
  // The last cell of a wrapped field ends at the first column.
  if (plain < count)
    steepest[plain] =
        std::max(steepest[plain], std::abs(static_cast<float>(row[0]) - static_cast<float>(samples[plain])));
}

// The same between two rows of samples.
template <class T>
void add_across(const T* north, const T* south, int count, float* steepest) {
  for (int i = 0; i < count; ++i) {
    const float rise = std::abs(static_cast<float>(south[i]) - static_cast<float>(north[i]));
    steepest[i] = rise > steepest[i] ? rise : steepest[i];
  }
}

// Two rows of samples without nodata.
template <class T>
class FilledRows {
 public:
  FilledRows(const SampleGrid<T>& grid, float lowest) : grid_(grid), lowest_(static_cast<T>(lowest)) {}
  const T* operator()(int row) {
    if (!grid_.has_holes) return grid_.row(row);
    std::vector<T>& to = rows_[++last_ & 1];
    to.assign(grid_.row(row), grid_.row(row) + grid_.cols);
    for (T& sample : to) sample = grid_.is_nodata(sample) ? lowest_ : sample;
    return to.data();
  }

 private:
  const SampleGrid<T>& grid_;
  T lowest_;
  std::vector<T> rows_[2];
  unsigned last_ = 0;
};

// One row of blocks, columns [block_begin, block_end).
template <class T>
void build_row(const SampleGrid<T>& grid, float lowest, int block_row, int block_begin, int block_end,
               std::vector<float>& along, std::vector<float>& across, float* to) {
  FilledRows<T> filled(grid, lowest);
  const int begin = block_begin * kSide, end = std::min(block_end * kSide, grid.cell_cols), count = end - begin;
  const int plain = std::min(count, grid.cols - 1 - begin), nodes = std::min(count + 1, grid.cols - begin);
  const int first = block_row * kSide, last = std::min(first + kSide, grid.cell_rows);
  std::fill_n(along.begin(), count, 0.0f);
  std::fill_n(across.begin(), count + 1, 0.0f);
  for (int row = first; row <= last; ++row) {
    const T* samples = filled(row < grid.rows ? row : 0);
    add_along(samples, begin, plain, count, along.data());
    if (row == last) break;
    const T* south = filled(grid.south(row));
    add_across(samples + begin, south + begin, nodes, across.data());
    if (nodes <= count)
      across[static_cast<std::size_t>(count)] =
          std::max(across[static_cast<std::size_t>(count)],
                   std::abs(static_cast<float>(south[0]) - static_cast<float>(samples[0])));
  }
  for (int block = block_begin; block < block_end; ++block) {
    const int from = block * kSide - begin, until = std::min(from + kSide, count);
    float steepest = *std::max_element(along.data() + from, along.data() + until);
    steepest = std::max(steepest, *std::max_element(across.data() + from, across.data() + until + 1));
    to[block] = rounded_up(steepest);
  }
}

}  // namespace

void ReliefMap::build(const HeightField& field) {
  cols_ = (field.cell_cols() + kSide - 1) / kSide;
  rows_ = (field.cell_rows() + kSide - 1) / kSide;
  if (!field.has_cells()) cols_ = rows_ = 0;
  blocks_.resize(static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_));
  update(field, {0, 0, field.cell_cols(), field.cell_rows()});
}

void ReliefMap::update(const HeightField& field, CellBox changed) {
  if (blocks_.empty()) return;
  const float lowest = field.all_nodata() ? 0 : static_cast<float>(field.min_sample());
  if (holes_ && lowest != lowest_) changed = {0, 0, field.cell_cols(), field.cell_rows()};
  lowest_ = lowest, holes_ = field.nodata_count() > 0;
  for (const CellBox& part : parts_inside(field, changed)) {
    const int col_begin = part.col_begin / kSide, col_end = (part.col_end + kSide - 1) / kSide;
    const int row_begin = part.row_begin / kSide, row_end = (part.row_end + kSide - 1) / kSide;
    const int width = part.col_end - part.col_begin;
    field.visit([&](const auto& grid) {
      parallel_for(row_end - row_begin, std::max<std::int64_t>(1, rows_per_piece(width) / kSide),
                   [&](std::int64_t first, std::int64_t last) {
                     const auto cells = static_cast<std::size_t>((col_end - col_begin) * kSide) + 1;
                     std::vector<float> along(cells), across(cells);
                     for (int row = row_begin + static_cast<int>(first); row < row_begin + last; ++row) {
                       build_row(grid, lowest, row, col_begin, col_end, along, across,
                                 blocks_.data() + static_cast<std::ptrdiff_t>(row) * cols_);
                     }
                   });
    });
  }
}

}  // namespace scarp
