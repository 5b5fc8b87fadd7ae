// SPDX-License-Identifier: MIT
// Typed view of samples in memory, for code that works on one sample type.
#pragma once

#include <cstddef>
#include <type_traits>

namespace scarp {

/// Corner heights of a cell, in sample units: h10 is at (col+1, row), h01 at (col, row+1).
struct CellHeights {
  double h00, h10, h01, h11;
};

/// A rectangle of samples: columns [col, col + cols), rows [row, row + rows).
struct SampleRect {
  int col = 0;
  int row = 0;
  int cols = 0;
  int rows = 0;
};

/// A non-owning view of samples; rows from north to south.
template <class T>
struct SampleGrid {
  const T* data = nullptr;
  std::ptrdiff_t row_stride = 0;  ///< in samples, from one row to the next one south; may be negative
  int cols = 0;
  int rows = 0;
  int cell_cols = 0;       ///< cols - 1, or cols if the last column is followed by the first
  int cell_rows = 0;       ///< as cell_cols
  bool has_holes = false;  ///< whether any sample is nodata
  T nodata{};              ///< value that marks a hole (besides NaN in float32); undefined without holes

  const T* row(int r) const { return data + r * row_stride; }
  T at(int col, int r) const { return row(r)[col]; }
  /// Column to the east and row to the south; wrap around after the last one.
  int east(int col) const { return col + 1 < cols ? col + 1 : 0; }
  int south(int r) const { return r + 1 < rows ? r + 1 : 0; }

  bool is_nodata(T sample) const {
    if constexpr (std::is_floating_point_v<T>) return has_holes && (sample == nodata || sample != sample);
    return has_holes && sample == nodata;
  }
  /// Returns whether a cell has a nodata sample at one of its corners.
  bool is_hole(int col, int r) const {
    return has_holes && (is_nodata(at(col, r)) || is_nodata(at(east(col), r)) || is_nodata(at(col, south(r))) ||
                         is_nodata(at(east(col), south(r))));
  }
  // Part of every march's inner loop.
  [[gnu::always_inline]] CellHeights cell(int col, int r) const {
    const T *north = row(r), *beyond = row(south(r));
    const int next = east(col);
    return {static_cast<double>(north[col]), static_cast<double>(north[next]), static_cast<double>(beyond[col]),
            static_cast<double>(beyond[next])};
  }
};

}  // namespace scarp
