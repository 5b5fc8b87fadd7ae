// SPDX-License-Identifier: MIT
// A ray of `max-mip` beside the ground: outside the field or over a hole, within the allowance of the rim.
//
//          ground      | allowance |   hole or outside
//   ___________________|___________|
//                      A     o            The ground continues as high as its rim. A ray that sinks through it at o
//                             \           hits there, at its own t, whether it arrives or leaves.
//                              \.
//
// The allowance is that of rounding_of_line(): rounding moves the ray and the line by up to that much. A nearly
// vertical ray stays within it for a long time and passes all heights; what counts is the time at which it is as high
// as the rim. The clearance above one edge is linear, because the position is clamped to it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "scarp/base/kept_memory.h"
#include "scarp/march/height/cells_beside.h"
#include "scarp/march/height/grid_axis.h"
#include "scarp/march/height/rim_time.h"
#include "scarp/march/height/rounding.h"
#include "scarp/march/height/walk_ground.h"

namespace scarp::max_mip {
namespace {

// Side of the ray at the entry of the current cell, as far as known. Without holes it is unknown in the first cell
// only.
enum class Side { unknown, above, below };

// Cells, first and last.
struct RimBox {
  int west, east, north, south;
};

inline double relief(const CellHeights& h) {
  return std::max({h.h00, h.h10, h.h01, h.h11}) - std::min({h.h00, h.h10, h.h01, h.h11});
}

// A ray beside the ground: its side, and whether it came from outside or over a hole. A ray that has sunk below the rim
// is not in the ground: walls are ahead, and rising through the rim is not a hit.
struct RimSide {
  Side side = Side::unknown;
  bool came = true;
};

// The part of a ray within the allowance of a cell with ground, and its clearances there.
struct RimStretch {
  double begin, end, above_begin, above_end;
  int col, row;
  double relief;
};

template <class T, bool Wraps, bool MayInvert>
struct Rim {
  using Axis = GridAxis<Wraps>;

  const HeightField& field;
  const WalkGround<T, MayInvert>& ground;
  const Axis &x, &y;
  const GridRay ray;
  double seam, seam_step;

  double off(int axis) const { return rounding_of_line(field, ray, axis, seam); }
  double height(double t) const { return ray.origin.z + ray.direction.z * t; }
  // How long the ray is within the allowance of a line on either side of it.
  double late_x() const { return x.moves() ? off(0) * std::abs(x.per_direction) : 0.0; }
  double late_y() const { return y.moves() ? off(1) * std::abs(y.per_direction) : 0.0; }

  // The latest time at which a ray that leaves the field may touch its rim, and the earliest for a ray that enters.
  double last_time() const { return std::min(x.exit_time() + late_x(), y.exit_time() + late_y()); }
  double first_time() const { return std::max(x.enter_time() - late_x(), y.enter_time() - late_y()); }

  // Whether a ray that is parallel to an axis is over the field's strip; written so that NaN is not.
  bool over_strips() const {
    const auto over = [&](const Axis& axis, int number) {
      return axis.moves() || (axis.origin >= -off(number) && axis.origin <= axis.cells + off(number));
    };
    return over(x, 0) && over(y, 1);
  }

  // Whether the ray is not above all ground during this time range, which may be empty.
  bool may_touch(double begin, double end) const {
    if (!(begin <= end)) return false;
    const double above = std::min(height(begin), height(end)) - ground.highest();
    return above <= 0 || above <= 2 * rounding_of_clearance(field, ray, std::max(std::abs(begin), std::abs(end)));
  }
  // The cells that the ray may touch from outside the field.
  RimBox cells_under(double begin, double end) const {
    const auto first = [&](const Axis& axis) { return axis.near(std::min(axis.at(begin), axis.at(end)) - 0.5); };
    const auto last = [&](const Axis& axis) { return axis.near(std::max(axis.at(begin), axis.at(end)) + 0.5); };
    return {first(x), last(x), first(y), last(y)};
  }

  // Whether the height of a hit at t is between the lowest and the highest ground, up to rounding; for a wall, not
  // above.
  bool is_height_of_ground(double t, bool wall) const {
    const double relief = ground.highest() - ground.lowest();
    const double beside = (field.nodata_count() > 0 ? 1 + kQuickRim : 1) * (off(0) + off(1)) * relief;
    const double subnormal = 4 * std::numeric_limits<double>::denorm_min();
    const double room = 2 * rounding_of_clearance(field, ray, t) + seam_step + beside + subnormal;
    // Also true if coordinates are so large that their rounding is not finite.
    return !(height(t) > ground.highest() + room) && (wall || !(height(t) < ground.lowest() - room));
  }

  // Whether the height of a hit at t is not finite: walls have no lower end, but the position on them must be a number.
  bool overflows(double t) const { return !std::isfinite(ground.metres(height(t))); }

  // Whether the ray must be followed along rims, cell by cell, from this time on, wherever its range ends.
  bool slow(double begin) const {
    const double end = Wraps ? std::numeric_limits<double>::infinity() : std::min(x.exit_time(), y.exit_time());
    return lingers_at_line(field, ray, ground.lowest(), ground.highest(), begin, end, seam);
  }

  // The height by which the ray may be below the ground at t and still touch it, where it crosses a line of an axis
  // (-1: no line) into a cell of this relief, from outside or from a hole, whether or not it was followed within the
  // allowance.
  double rounding_at(double t, double of_cell, int axis, bool from_hole, bool followed) const {
    if (axis < 0) return rounding_of_clearance(field, ray, t, of_cell);
    if (from_hole && !followed) return rounding_at_hole(field, ray, t, of_cell, axis, seam);
    return seam_step + rounding_at_rim(field, ray, t, of_cell, seam);
  }

  // Calls f(col, row, place, clearance, relief) for the ground of the cells that meet at the ray's position on a line,
  // until f returns true, and then returns true. Rims are closed, so any of these cells is valid.
  template <class F>
  bool any_beside(double t, const F& f) const {
    const CellsBeside cols(x, t, off(0)), rows(y, t, off(1));
    for (int i = 0; i < cols.count * rows.count; ++i) {
      const int west = i % cols.count, north = i / cols.count, col = cols.cell[west], row = rows.cell[north];
      if (!x.inside(col) || !y.inside(row) || ground.is_hole(col, row)) continue;
      const CellHeights h = ground.cell(col, row);
      const dvec2 place(cols.place[west], rows.place[north]);
      const double above = height(t) - height_in_cell(field.settings().surface, h, place.x, place.y);
      if (f(col, row, place, above, relief(h))) return true;
    }
    return false;
  }

  // Calls touch(col, row, place) where the ray touches ground at its position on a line. Stops and returns true if
  // touch() does; stops after the first touch unless `all`.
  template <class Touch>
  bool touched_at(double t, bool all, const Touch& touch) const {
    bool answered = false;
    any_beside(t, [&](int col, int row, const dvec2& place, double above, double of_cell) {
      // Rounding of the cell: less than the height that a ray from below must rise.
      if (!(std::abs(above) <= rounding_of_clearance(field, ray, t, of_cell))) return false;
      answered = touch(col, row, place);
      return answered || !all;
    });
    return answered;
  }

  // Maximum distance from a node, along a line of an axis in cells, of a ray that crosses the line and is within the
  // allowance of both lines when it crosses the other one.
  double beside_node(int axis) const {
    const double slope = std::abs(ray.direction[1 - axis]) / std::abs(ray.direction[axis]);
    const double off = std::max(this->off(0), this->off(1));
    return off + off * (slope < kQuickRim ? slope : 0.0);
  }
  // Time at which a ray that crosses a line of an axis at t passes the nearest line of the other axis; NaN if that is
  // not between t and `last`.
  double node_time(double t, int axis, double last) const {
    const Axis& other = axis == 0 ? y : x;
    const double node = (std::round(other.at(t)) - other.origin) * other.per_direction;
    return node > t && node < last ? node : std::numeric_limits<double>::quiet_NaN();
  }

  // Whether a ray that leaves the ground over a line of an axis, into a hole, may sink through the rim before it leaves
  // the allowance.
  bool may_sink(double t, int axis) const {
    return any_beside(t, [&](int, int, const dvec2&, double above, double of_cell) {
      return above <= rounding_at_hole(field, ray, t, of_cell, axis, seam);
    });
  }

  // Follows the ray from `begin` to `end` past the cells of `box` with ground. `at`: the ray's side at `begin`; set to
  // that at `end`, unknown if no ground is beside the ray there. `goes_in`: whether the ray is over the field at `end`.
  // touch(stretch, t, place) records a hit and returns whether that is the answer, as does the function.
  template <class Touch>
  bool follow(double begin, double end, const RimBox& box, bool goes_in, RimSide& at, const Touch& touch) const {
    const double last = end;
    double reached = begin;
    RimSide to = std::exchange(at, {});
    if (!clip_to_heights(field, ray, ground.lowest(), ground.highest(), begin, end)) return false;
    Side& side = to.side;
    bool first = true;
    KeptVector<RimStretch> all;
    find_stretches(begin, end, box, all);
    for (RimStretch s : all) {
      if (!std::exchange(first, false) && s.end <= reached) continue;
      if (s.begin > reached) to = {};
      // Cells that share a rim overlap: the ray has been followed up to here.
      if (s.begin < reached) {
        s.above_begin += (reached - s.begin) / (s.end - s.begin) * (s.above_end - s.above_begin);
        s.begin = reached;
      }
      reached = s.end;
      const double rounding = rounding_of_clearance(field, ray, s.begin, s.relief);
      if (side == Side::unknown) {
        const double touched = seam_step + rounding_at_rim(field, ray, s.begin, s.relief, seam);
        side = s.above_begin >= -touched ? Side::above : Side::below;
      }
      bool touches = false;
      if (side == Side::above) {
        // If the ray does not sink before it is over the field, it hits there.
        touches = s.above_end < 0 || (!goes_in && s.above_begin <= 0);
      } else if (s.above_end > rounding_of_clearance(field, ray, s.end)) {
        side = Side::above;
      }
      if (!touches) continue;
      const double share = s.above_begin > 0 ? s.above_begin / (s.above_begin - s.above_end) : 0.0;
      to.came = false;
      const double t = std::min(s.begin + share * (s.end - s.begin), s.end);
      side = s.above_end > rounding ? Side::above : Side::below;
      if (touch(s, t, dvec2{x.place(t, s.col), y.place(t, s.row)})) return true;
    }
    if (reached >= last) at = to;
    return false;
  }

 private:
  // Limits a time range to the part in which the ray is at most `allowance` beside a cell. Returns whether any is left.
  static bool clip_to_cell(const Axis& axis, int cell, double allowance, double& begin, double& end) {
    const auto low = static_cast<double>(axis.global_line(cell)) - allowance;
    const auto high = static_cast<double>(axis.global_line(cell + 1)) + allowance;
    if (!axis.moves()) return axis.origin >= low && axis.origin <= high && begin <= end;
    const double a = (low - axis.origin) * axis.per_direction, b = (high - axis.origin) * axis.per_direction;
    begin = std::max(begin, std::min(a, b)), end = std::min(end, std::max(a, b));
    return begin <= end;
  }

  // Sorted by start. The clearance has a kink where the ray passes the end of an edge.
  void find_stretches(double begin, double end, const RimBox& box, std::vector<RimStretch>& found) const {
    for (int row = box.north; row <= box.south; ++row) {
      for (int col = box.west; col <= box.east; ++col) {
        const int own_col = x.within(col), own_row = y.within(row);
        if (!x.inside(own_col) || !y.inside(own_row)) continue;
        RimStretch s{begin, end, 0, 0, col, row, 0};
        if (!clip_to_cell(x, col, off(0), s.begin, s.end) || !clip_to_cell(y, row, off(1), s.begin, s.end)) continue;
        if (ground.is_hole(own_col, own_row)) continue;
        const CellHeights h = ground.cell(own_col, own_row);
        const auto above = [&](double t) {
          return height(t) - height_in_cell(field.settings().surface, h, x.place(t, col), y.place(t, row));
        };
        s.above_begin = above(s.begin), s.relief = relief(h);
        double corners[] = {x.line_time(col), x.line_time(col + 1), y.line_time(row), y.line_time(row + 1)};
        std::sort(std::begin(corners), std::end(corners));
        const auto add = [&](double to) {
          const double last = std::exchange(s.end, to);
          s.above_end = above(s.end);
          found.push_back(s);
          s.begin = std::exchange(s.end, last), s.above_begin = s.above_end;
        };
        for (const double t : corners) {
          if (t > s.begin && t < s.end) add(t);
        }
        add(s.end);
      }
    }
    std::sort(found.begin(), found.end(), [](const RimStretch& a, const RimStretch& b) { return a.begin < b.begin; });
  }
};

}  // namespace
}  // namespace scarp::max_mip
