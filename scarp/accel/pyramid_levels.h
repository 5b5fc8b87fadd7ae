// SPDX-License-Identifier: MIT
// The levels of a pyramid over a height field's cells, wherever its entries lie.
#pragma once

#include <cstddef>
#include <vector>

#include "scarp/field/height_field.h"

namespace scarp {

/// Where a level begins, in entries from the begin of level 1, and its size; rows from north to south, no padding.
struct PyramidLevel {
  std::ptrdiff_t begin;
  int cols;
  int rows;
};

/// Levels 1, 2, ... up to the first of one entry, each half of the one below, rounded up; none where there are no
/// cells.
std::vector<PyramidLevel> pyramid_levels(const HeightField& field);

/// The entries of the next coarser level over some cells, or over some entries.
inline CellBox coarser(const CellBox& box) {
  return {box.col_begin / 2, box.row_begin / 2, (box.col_end + 1) / 2, (box.row_end + 1) / 2};
}

/// Boxes inside the field that hold the cells of one that begins at -1, beyond the seam of a field that wraps round:
/// they are at the other side.
std::vector<CellBox> parts_inside(const HeightField& field, const CellBox& box);

}  // namespace scarp
