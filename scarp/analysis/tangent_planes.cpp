// SPDX-License-Identifier: MIT
#include "scarp/analysis/tangent_planes.h"

#include <cmath>
#include <optional>

#include "scarp/analysis/sight.h"
#include "scarp/base/parallel.h"

namespace scarp {

TangentPlanes::TangentPlanes(const HeightField& field, const RowBand& band) {
  const std::ptrdiff_t cols = field.cols();
  for (auto* numbers : {&east, &north, &level}) numbers->resize(static_cast<std::size_t>(cols * band.rows()));
  const SightGround ground(field);
  const auto height = [&](int col, int row) -> std::optional<double> {
    if (col < 0 || row < 0 || col >= field.cols() || row >= field.rows()) return std::nullopt;
    return ground.height({col, row});
  };
  const auto slope = [](std::optional<double> before, double here, std::optional<double> after, double cell) {
    if (before && after) return (*after - *before) / (2 * cell);
    if (after) return (*after - here) / cell;
    return before ? (here - *before) / cell : 0;
  };
  parallel_for(band.rows(), 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::ptrdiff_t i = begin * cols; i < end * cols; ++i) {
      const int col = static_cast<int>(i % cols), row = band.first + static_cast<int>(i / cols);
      const auto here = height(col, row);
      if (!here) continue;
      const double x = slope(height(col - 1, row), *here, height(col + 1, row), field.settings().cell_x);
      const double y = slope(height(col, row + 1), *here, height(col, row - 1), field.settings().cell_y);
      const double length = 1 / std::sqrt(1 + x * x + y * y);
      const auto at = static_cast<std::size_t>(i);
      east[at] = static_cast<float>(-x * length), north[at] = static_cast<float>(-y * length);
      level[at] = static_cast<float>(length);
    }
  });
}

}  // namespace scarp
