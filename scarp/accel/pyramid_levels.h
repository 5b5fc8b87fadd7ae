// SPDX-License-Identifier: MIT
// Level layout of a pyramid over a height field's cells.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scarp/field/height_field.h"

namespace scarp {

/// Offset of a level in entries from the start of level 1, and its size; rows from north to south, no padding.
struct PyramidLevel {
  std::ptrdiff_t begin;
  int cols;
  int rows;
};

/// Returns levels 1, 2, ... up to the first with one entry, each half the size of the finer one, rounded up; none
/// without cells.
std::vector<PyramidLevel> pyramid_levels(const HeightField& field);

/// Returns the entries of the next coarser level that cover a box of cells or entries.
inline CellBox coarser(const CellBox& box) {
  return {box.col_begin / 2, box.row_begin / 2, (box.col_end + 1) / 2, (box.row_end + 1) / 2};
}

/// Returns how many rows of `cols` entries one thread builds at a time.
inline std::int64_t rows_per_piece(int cols) {
  constexpr std::int64_t kEntriesPerPiece = 1 << 16;
  return std::max<std::int64_t>(1, kEntriesPerPiece / std::max(cols, 1));
}

/// Splits a box of a wrapped field that begins at -1, beyond the seam, into boxes within the field.
std::vector<CellBox> parts_inside(const HeightField& field, const CellBox& box);

}  // namespace scarp
