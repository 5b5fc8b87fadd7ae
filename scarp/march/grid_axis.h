// SPDX-License-Identifier: MIT
// One axis of a ray over a grid: when it crosses the grid's lines, and which cell it is in.
//
// Every line k has ONE time, (k - origin) * (1 / direction), whatever cell or level asks. Rounding keeps these times in
// the order of k, so cells found through them follow one another without gap or overlap.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace scarp {

struct GridAxis {
  double origin;       // in cells
  double direction;    // cells per t
  double time_origin;  // origin, as line_time() takes it
  double per_direction;
  int step;   // +1 or -1
  int ahead;  // 1 if the line left through has a higher number than the cell, else 0
  int cells;

  GridAxis(double o, double d, int cell_count)
      : origin(o), direction(d), time_origin(o), per_direction(1 / d), cells(cell_count) {
    step = d < 0 ? -1 : 1;
    ahead = d < 0 ? 0 : 1;
    if (std::isinf(per_direction)) {
      // No movement along this axis (or less than 2^-1022 cells per t): the lines on the near side are crossed at -inf,
      // those on the far side at +inf. A ray along a line belongs to the cell after it, on the last line to the last
      // cell.
      direction = 0;
      step = ahead = 1;
      per_direction = std::numeric_limits<double>::infinity();
      time_origin = cell_at(o) + 0.5;
    }
  }

  bool moves() const { return direction != 0; }
  double at(double t) const { return origin + direction * t; }
  double line_time(int line) const { return (line - time_origin) * per_direction; }
  double enter_time() const { return line_time(ahead ? 0 : cells); }
  double exit_time() const { return line_time(ahead ? cells : 0); }
  bool inside(int cell) const { return static_cast<unsigned>(cell) < static_cast<unsigned>(cells); }

  // The cell at a position, clamped to the grid; NaN goes to 0.
  int cell_at(double position) const { return static_cast<int>(std::min(std::max(0.0, position), cells - 1.0)); }

  // The cell at time t by the order of line times alone; the position is only where to look first. Lines crossed
  // exactly at t are behind the cell (cell_after) or still ahead of it (cell_before).
  int cell_after(double t) const {
    return ordered_cell(t, [&](int line) { return line_time(line) <= t; });
  }
  int cell_before(double t) const {
    return ordered_cell(t, [&](int line) { return line_time(line) < t; });
  }

 private:
  template <class Behind>
  int ordered_cell(double t, Behind behind) const {
    int cell = cell_at(at(t));
    while (inside(cell + step) && behind(cell + ahead)) cell += step;
    while (inside(cell - step) && !behind(cell + 1 - ahead)) cell -= step;
    return cell;
  }
};

}  // namespace scarp
