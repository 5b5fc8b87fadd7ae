// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon_crossings.h"

#include <algorithm>
#include <cmath>

namespace scarp {

HorizonCrossings::HorizonCrossings(const HeightField& field, double azimuth, double reach,
                                   const SightCurvature& curvature, const std::optional<dvec2>& cells)
    : curvature_(curvature.per_square_metre()) {
  const double cell_x = cells ? cells->x : field.settings().cell_x, cell_y = cells ? cells->y : field.settings().cell_y;
  const double cols = std::sin(azimuth) / cell_x, rows = -std::cos(azimuth) / cell_y;
  along_columns_ = std::abs(cols) >= std::abs(rows) * (1 - kNoDirection);
  col_sign_ = cols < 0 ? -1 : 1, row_sign_ = rows < 0 ? -1 : 1;
  const double major = std::abs(along_columns_ ? cols : rows), minor = std::abs(along_columns_ ? rows : cols);
  tilt_ = std::min(minor / major, 1.0);
  if (tilt_ < kNoDirection) tilt_ = 0;
  if (tilt_ > 1 - kNoDirection) tilt_ = 1;
  const double major_cell = along_columns_ ? cell_x : cell_y, minor_cell = along_columns_ ? cell_y : cell_x;
  step_ = std::hypot(major_cell, tilt_ * minor_cell);

  const int across = along_columns_ ? field.cols() : field.rows(), aside = along_columns_ ? field.rows() : field.cols();
  const auto add = [&](double steps, int on_major, int on_minor, bool is_major, double w) {
    const double distance = steps * step_, side = is_major ? minor_cell : major_cell;
    HorizonCrossing to{};
    const auto set = [&](std::int32_t& col, std::int32_t& row, int along, int beside) {
      col = (along_columns_ ? along : beside) * col_sign_, row = (along_columns_ ? beside : along) * row_sign_;
    };
    set(to.col, to.row, on_major, on_minor);
    if (w > 0) set(to.second_col, to.second_row, is_major ? 0 : 1, is_major ? 1 : 0);
    to.w = static_cast<float>(w);
    to.per_distance = static_cast<float>(1 / distance);
    to.drop = static_cast<float>(curvature_ * (distance * distance + w * (1 - w) * side * side) / distance);
    to.steps = steps;
    all_.push_back(to);
  };
  // A weight as a float below 1.
  const auto below_one = [](double w) { return std::clamp(w, 0.0, static_cast<double>(0x1.fffffep-1f)); };

  major_.push_back(0), minor_.push_back(0);
  int q = 1;
  for (int k = 1; k < across; ++k) {
    // One number decides which lines come first, and what is a node: where line k is crossed.
    double place = k * tilt_;
    if (std::abs(place - std::round(place)) <= HeightField::rounding_of_line(place, across + aside))
      place = std::round(place);
    for (; q < aside && q < place; ++q) {
      const double steps = q / tilt_;
      if (steps * step_ > reach) break;
      add(steps, k - 1, q, false, below_one(steps - (k - 1)));
      minor_.push_back(static_cast<std::uint32_t>(all_.size()));
    }
    if (k * step_ > reach || place > aside - 1) break;
    const int beside = static_cast<int>(place);
    add(k, k, beside, true, below_one(place - beside));
    major_.push_back(static_cast<std::uint32_t>(all_.size()));
    if (q < aside && q == place) {
      ++q;
      minor_.push_back(static_cast<std::uint32_t>(all_.size()));
    }
  }
}

}  // namespace scarp
