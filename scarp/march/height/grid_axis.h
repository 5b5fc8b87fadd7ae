// SPDX-License-Identifier: MIT
// One axis of a ray over a grid: crossing times of grid lines, and the current cell.
//
// Every line k has ONE time, (k - origin) * (1 / direction), regardless of the cell or level that uses it. Rounding
// keeps these times in the order of k, so cells found through them follow one another without gap or overlap.
//
// A wrapped grid has a line for every integer. Cells and lines are counted within one copy of the grid, from its first
// line on, and the copy is part of the state. Values at a line are computed from its integer, so neighbours on both
// sides of a seam agree like all others.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace scarp {

/// The number of a cell, line or node in the first copy of a wrapped grid.
inline int in_first_copy(int number, int cells) {
  const int rest = number % cells;
  return rest < 0 ? rest + cells : rest;
}

/// Compiled separately for wrapped grids, so that rays over other grids do not pay for it.
template <bool Wraps>
class GridAxis {
 public:
  double origin;     // in cells
  double direction;  // cells per t
  double per_direction;
  int step;   // +1 or -1
  int ahead;  // 1 if the line ahead has a higher number than the cell, otherwise 0
  int cells;

  GridAxis(double o, double d, int cell_count)
      : origin(o), direction(d), per_direction(1 / d), cells(cell_count), time_origin_(o) {
    step = d < 0 ? -1 : 1;
    ahead = d < 0 ? 0 : 1;
    if (std::isinf(per_direction)) {
      // No movement along this axis (or less than 2^-1022 cells per t): the lines on the near side are crossed at -inf,
      // those on the far side at +inf. A ray along a line belongs to the cell after it; on the last line of a grid
      // without wrap, to the last cell.
      direction = 0;
      step = ahead = 1;
      per_direction = std::numeric_limits<double>::infinity();
      if constexpr (Wraps) set_copy(static_cast<std::int64_t>(std::floor(o)));
      time_origin_ = static_cast<double>(first() + near(o)) + 0.5;
    }
  }

  bool moves() const { return direction != 0; }
  double at(double t) const { return origin + direction * t; }
  /// Position in a cell at time t, 0..1.
  double place(double t, int cell) const { return std::clamp(at(t) - static_cast<double>(first() + cell), 0.0, 1.0); }
  double line_time(int line) const { return global_line_time(first() + line); }
  /// Times at which the ray enters and leaves this copy of the grid.
  double enter_time() const { return line_time(ahead ? 0 : cells); }
  double exit_time() const { return line_time(ahead ? cells : 0); }
  bool inside(int cell) const { return static_cast<unsigned>(cell) < static_cast<unsigned>(cells); }
  /// Converts a cell counted in this copy to a cell of the grid; outside, if the grid does not wrap.
  int within(int cell) const { return Wraps ? in_first_copy(cell, cells) : cell; }
  /// Number of a line among all lines of the plane.
  std::int64_t global_line(int line) const { return first() + line; }

  // The cell at time t by the order of line times alone; the position is only the initial guess. Lines crossed exactly
  // at t are behind the cell (after) or still ahead of it (before). In a wrapped grid, the copy becomes that of the
  // cell.
  int cell_after(double t) {
    return ordered_cell(t, [&](std::int64_t line) { return global_line_time(line) <= t; });
  }
  int cell_before(double t) {
    return ordered_cell(t, [&](std::int64_t line) { return global_line_time(line) < t; });
  }
  // Places the ray in `cell` at time t; in a wrapped grid, in the copy below it. A ray along a line belongs to the cell
  // that it is given.
  void begin_in(int cell, double t) {
    if constexpr (Wraps) first_ = static_cast<std::int64_t>(std::round((at(t) - cell - 0.5) / cells)) * cells;
    if (!moves()) time_origin_ = static_cast<double>(first() + cell) + 0.5;
  }
  // The cell of this copy nearest to a position; NaN becomes 0.
  int near(double position) const {
    return static_cast<int>(std::min(std::max(0.0, position - static_cast<double>(first())), cells - 1.0));
  }
  // Moves to the next copy; returns its first cell.
  int enter_next_copy() {
    first_ += step * std::int64_t{cells};
    return ahead ? 0 : cells - 1;
  }

 private:
  // An int if always 0, so that counting lines uses int, too.
  auto first() const {
    if constexpr (Wraps) {
      return first_;
    } else {
      return 0;
    }
  }
  template <class Line>
  double global_line_time(Line line) const {
    return (static_cast<double>(line) - time_origin_) * per_direction;
  }

  void set_copy(std::int64_t global_cell) {
    const std::int64_t within = ((global_cell % cells) + cells) % cells;
    first_ = global_cell - within;
  }

  template <class Behind>
  int ordered_cell(double t, Behind behind) {
    if constexpr (!Wraps) {
      int cell = near(at(t));
      while (inside(cell + step) && behind(cell + ahead)) cell += step;
      while (inside(cell - step) && !behind(cell + 1 - ahead)) cell -= step;
      return cell;
    }
    if (!moves()) return near(origin);
    auto cell = static_cast<std::int64_t>(std::floor(at(t)));
    while (behind(cell + ahead)) cell += step;
    while (!behind(cell + 1 - ahead)) cell -= step;
    set_copy(cell);
    return static_cast<int>(cell - first_);
  }

  double time_origin_;      // origin, as used for line times
  std::int64_t first_ = 0;  // first line of this copy of the grid
};

}  // namespace scarp
