// SPDX-License-Identifier: MIT
#include "scarp/accel/pyramid_levels.h"

#include <algorithm>

namespace scarp {

std::vector<PyramidLevel> pyramid_levels(const HeightField& field) {
  std::vector<PyramidLevel> levels;
  if (!field.has_cells()) return levels;
  std::ptrdiff_t begin = 0;
  for (int cols = field.cell_cols(), rows = field.cell_rows(); levels.empty() || cols > 1 || rows > 1;) {
    cols = (cols + 1) / 2;
    rows = (rows + 1) / 2;
    levels.push_back({begin, cols, rows});
    begin += static_cast<std::ptrdiff_t>(cols) * rows;
  }
  return levels;
}

std::vector<CellBox> parts_inside(const HeightField& field, const CellBox& box) {
  std::vector<CellBox> parts;
  const auto add = [&](int col_begin, int col_end) {
    parts.push_back({col_begin, std::max(box.row_begin, 0), col_end, box.row_end});
    if (box.row_begin < 0) parts.push_back({col_begin, field.cell_rows() - 1, col_end, field.cell_rows()});
  };
  add(std::max(box.col_begin, 0), box.col_end);
  if (box.col_begin < 0) add(field.cell_cols() - 1, field.cell_cols());
  return parts;
}

}  // namespace scarp
