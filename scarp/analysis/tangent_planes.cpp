// SPDX-License-Identifier: MIT
#include "scarp/analysis/tangent_planes.h"

#include <cmath>
#include <optional>

#include "scarp/base/parallel.h"

namespace scarp {
namespace {

// From the heights before, at and after a place along an axis.
double slope_of(std::optional<double> before, double here, std::optional<double> after, double cell) {
  if (before && after) return (*after - *before) / (2 * cell);
  if (after) return (*after - here) / cell;
  return before ? (here - *before) / cell : 0;
}

}  // namespace

TangentPlanes::TangentPlanes(const HeightField& field, const NodeRect& nodes, const dvec2& cells) {
  const std::ptrdiff_t cols = nodes.col_end - nodes.col_begin;
  for (auto* numbers : {&east, &north, &level}) numbers->resize(nodes.count());
  const SightGround ground(field);
  const auto height = [&](int col, int row) -> std::optional<double> {
    if (col < 0 || row < 0 || col >= field.cols() || row >= field.rows()) return std::nullopt;
    return ground.height({col, row});
  };
  parallel_for(nodes.row_end - nodes.row_begin, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::ptrdiff_t i = begin * cols; i < end * cols; ++i) {
      const int col = nodes.col_begin + static_cast<int>(i % cols), row = nodes.row_begin + static_cast<int>(i / cols);
      const auto here = height(col, row);
      if (!here) continue;
      const double x = slope_of(height(col - 1, row), *here, height(col + 1, row), cells.x);
      const double y = slope_of(height(col, row + 1), *here, height(col, row - 1), cells.y);
      const double length = 1 / std::sqrt(1 + x * x + y * y);
      const auto at = static_cast<std::size_t>(i);
      east[at] = static_cast<float>(-x * length), north[at] = static_cast<float>(-y * length);
      level[at] = static_cast<float>(length);
    }
  });
}

dvec3 upward_normal(const SightGround& ground, double col, double row) {
  const HeightFieldSettings& cells = ground.field().settings();
  const double here = *ground.height_at(col, row);
  const double x = slope_of(ground.height_at(col - 1, row), here, ground.height_at(col + 1, row), cells.cell_x);
  const double y = slope_of(ground.height_at(col, row + 1), here, ground.height_at(col, row - 1), cells.cell_y);
  return normalize(dvec3(-x, -y, 1));
}

}  // namespace scarp
