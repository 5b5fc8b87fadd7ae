// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon_crossings.h"

#include <algorithm>
#include <cmath>

namespace scarp {
namespace {

// A component or a difference of components this small is the rounding of the angle, not a direction.
constexpr double kNoDifference = 0x1p-40;

}  // namespace

HorizonCrossings::HorizonCrossings(const HeightField& field, double azimuth, double reach,
                                   const SightCurvature& curvature) {
  const double cell_x = field.settings().cell_x, cell_y = field.settings().cell_y;
  const double cols = std::sin(azimuth) / cell_x, rows = -std::cos(azimuth) / cell_y;
  along_columns_ = std::abs(cols) >= std::abs(rows) * (1 - kNoDifference);
  col_sign_ = cols < 0 ? -1 : 1, row_sign_ = rows < 0 ? -1 : 1;
  const double major = std::abs(along_columns_ ? cols : rows), minor = std::abs(along_columns_ ? rows : cols);
  tilt_ = std::min(minor / major, 1.0);
  if (tilt_ < kNoDifference) tilt_ = 0;
  if (tilt_ > 1 - kNoDifference) tilt_ = 1;
  const double major_cell = along_columns_ ? cell_x : cell_y, minor_cell = along_columns_ ? cell_y : cell_x;
  step_ = std::hypot(major_cell, tilt_ * minor_cell);

  const int across = along_columns_ ? field.cols() : field.rows(), aside = along_columns_ ? field.rows() : field.cols();
  const double c = curvature.per_square_metre();
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
    to.drop = static_cast<float>(c * (distance * distance + w * (1 - w) * side * side) / distance);
    to.steps = steps;
    all_.push_back(to);
  };
  // The fraction of a place between two lines, as a float below 1.
  const auto weight = [](double place) {
    return std::min(place - std::floor(place), static_cast<double>(0x1.fffffep-1f));
  };

  major_.push_back(0), minor_.push_back(0);
  int q = 1;
  for (int k = 1; k < across; ++k) {
    // Minor crossings come before the major one at the same time, where they are dropped as nodes.
    for (; tilt_ > 0 && q < aside && q / tilt_ < k; ++q) {
      const double steps = q / tilt_, w = weight(steps);
      if (steps * step_ > reach) break;
      if (static_cast<float>(w) > 0) add(steps, static_cast<int>(steps), q, false, w);
      minor_.push_back(static_cast<std::uint32_t>(all_.size()));
    }
    if (k * step_ > reach) break;
    const double place = k * tilt_;
    if (place > aside - 1) break;
    const double w = weight(place);
    add(k, k, static_cast<int>(place), true, static_cast<float>(w) > 0 ? w : 0);
    major_.push_back(static_cast<std::uint32_t>(all_.size()));
    if (tilt_ > 0 && q < aside && q / tilt_ == k) {
      ++q;
      minor_.push_back(static_cast<std::uint32_t>(all_.size()));
    }
  }
}

}  // namespace scarp
