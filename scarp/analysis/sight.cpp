// SPDX-License-Identifier: MIT
#include "scarp/analysis/sight.h"

#include <fmt/format.h>

#include "scarp/base/error.h"
#include "scarp/base/setting.h"

namespace scarp {

void validate(const SightCurvature& curvature) {
  require_setting("curvature", curvature.coefficient >= 0 && curvature.coefficient <= 10, "the coefficient",
                  curvature.coefficient, "0..10");
  require_setting("curvature", curvature.diameter > 0 && std::isfinite(curvature.diameter), "the diameter",
                  curvature.diameter, "> 0");
}

SightGround::SightGround(const HeightField& field)
    : field_(&field), cells_(field.settings().cell_x, field.settings().cell_y) {
  if (field.wraps()) throw Error("height field: maps need its borders (use a field without wrap)");
  if (field.cols() > kMaxSightSide || field.rows() > kMaxSightSide)
    throw Error(fmt::format("height field: {} x {} samples are too many for maps (limit: {} per side)", field.cols(),
                            field.rows(), kMaxSightSide));
  field.visit([&](const auto& grid) {
    samples_ = grid.data;
    row_stride_ = grid.row_stride;
    has_holes_ = grid.has_holes;
    nodata_ = static_cast<double>(grid.nodata);
  });
  type_ = field.sample_type();
}

SightGround::SightGround(const HeightField& field, double observer_col, double observer_row,
                         const SightCurvature& curvature, const std::optional<dvec2>& cells)
    : SightGround(field) {
  validate(curvature);
  if (cells) cells_ = *cells;
  for (const double length : {cells_.x, cells_.y})
    require_setting("line of sight", length > 0 && std::isfinite(length), "cell length", length, "finite, above 0");
  col_ = observer_col;
  row_ = observer_row;
  per_square_metre_ = curvature.per_square_metre();
}

std::optional<double> SightGround::height_at(double col, double row) const {
  if (!(col >= 0 && row >= 0 && col <= field_->cols() - 1 && row <= field_->rows() - 1)) return std::nullopt;
  const int c = static_cast<int>(col), r = static_cast<int>(row);
  const double u = col - c, v = row - r;
  // Samples with weight 0 do not count: they may be holes or outside.
  double sum = 0;
  for (int south = 0; south <= (v > 0); ++south)
    for (int east = 0; east <= (u > 0); ++east) {
      const auto h = height({c + east, r + south});
      if (!h) return std::nullopt;
      sum += *h * (east ? u : 1 - u) * (south ? v : 1 - v);
    }
  return sum;
}

}  // namespace scarp
