// SPDX-License-Identifier: MIT
#include "scarp/accel/max_pyramid.h"

#include <algorithm>
#include <limits>

#include "scarp/base/parallel.h"

namespace scarp {
namespace {

constexpr std::int64_t kEntriesPerPiece = 1 << 16;

std::int64_t rows_per_piece(int cols) { return std::max<std::int64_t>(1, kEntriesPerPiece / cols); }

template <class T>
constexpr T lowest() {
  if constexpr (std::is_floating_point_v<T>) return -std::numeric_limits<T>::infinity();
  return std::numeric_limits<T>::lowest();
}

// One row of cells: the maximum of each cell's four corners.
template <class T>
void maxima_of_cells(const SampleGrid<T>& grid, int row, T* maxima) {
  const T *north = grid.row(row), *south = grid.row(row + 1);
  const int cols = grid.cols - 1;
  for (int col = 0; col < cols; ++col) {
    maxima[col] = std::max(std::max(north[col], north[col + 1]), std::max(south[col], south[col + 1]));
  }
  if (!grid.has_holes) return;
  for (int col = 0; col < cols; ++col) {
    if (grid.is_hole(col, row)) maxima[col] = lowest<T>();
  }
}

// One row of a coarser level from two of the finer one (twice the same at an odd end).
template <class T>
void maxima_of_pairs(const T* north, const T* south, int fine_cols, T* maxima) {
  const int pairs = fine_cols / 2;
  for (int col = 0; col < pairs; ++col) {
    maxima[col] = std::max(std::max(north[2 * col], north[2 * col + 1]), std::max(south[2 * col], south[2 * col + 1]));
  }
  // An odd last column stands alone.
  if (fine_cols % 2 != 0) maxima[pairs] = std::max(north[2 * pairs], south[2 * pairs]);
}

// Level 1, from the samples; the rows of cells in between live for a moment only.
template <class T>
void build_first(const SampleGrid<T>& grid, T* out, int cols, int rows) {
  const int fine_cols = grid.cols - 1, fine_rows = grid.rows - 1;
  parallel_for(rows, rows_per_piece(cols), [&](std::int64_t begin, std::int64_t end) {
    std::vector<T> north(static_cast<std::size_t>(fine_cols)), south(north.size());
    for (int row = static_cast<int>(begin); row < end; ++row) {
      maxima_of_cells(grid, 2 * row, north.data());
      const bool pair = 2 * row + 1 < fine_rows;
      if (pair) maxima_of_cells(grid, 2 * row + 1, south.data());
      maxima_of_pairs(north.data(), pair ? south.data() : north.data(), fine_cols,
                      out + static_cast<std::ptrdiff_t>(row) * cols);
    }
  });
}

// A coarser level from the finer one.
template <class T>
void build_coarser(const PyramidLevel<T>& fine, T* out, int cols, int rows) {
  parallel_for(rows, rows_per_piece(cols), [&](std::int64_t begin, std::int64_t end) {
    for (int row = static_cast<int>(begin); row < end; ++row) {
      const T* north = fine.data + static_cast<std::ptrdiff_t>(2 * row) * fine.cols;
      const T* south = 2 * row + 1 < fine.rows ? north + fine.cols : north;
      maxima_of_pairs(north, south, fine.cols, out + static_cast<std::ptrdiff_t>(row) * cols);
    }
  });
}

}  // namespace

MaxPyramid::MaxPyramid(const HeightField& field) : type_(field.sample_type()) {
  if (!field.has_cells()) return;
  std::ptrdiff_t entries = 0;
  for (int cols = field.cell_cols(), rows = field.cell_rows(); levels_.empty() || cols > 1 || rows > 1;) {
    cols = (cols + 1) / 2;
    rows = (rows + 1) / 2;
    levels_.push_back({entries, cols, rows});
    entries += static_cast<std::ptrdiff_t>(cols) * rows;
  }
  field.visit([&](const auto& grid) {
    using T = std::remove_cvref_t<decltype(grid.data[0])>;
    // Not zeroed: each entry is written below, by the thread that makes it.
    const std::shared_ptr<T[]> data(new T[static_cast<std::size_t>(entries)]);
    bytes_ = static_cast<std::size_t>(entries) * sizeof(T);
    build_first(grid, data.get(), levels_[0].cols, levels_[0].rows);
    for (std::size_t l = 1; l < levels_.size(); ++l) {
      const Level &fine = levels_[l - 1], &coarse = levels_[l];
      build_coarser(PyramidLevel<T>{data.get() + fine.begin, fine.cols, fine.rows}, data.get() + coarse.begin,
                    coarse.cols, coarse.rows);
    }
    data_ = std::shared_ptr<const void>(data, data.get());
  });
}

}  // namespace scarp
