// SPDX-License-Identifier: MIT
// `max-mip` for all queries, see max_mip.h. Each class adds rules to the one below it.
//
//   Walk        where a ray starts and ends
//   BlockRules  over blocks: block_rules.h      ◀──  walk_blocks(): which blocks and cells, and when: block_walk.h
//   RimRules    beside the ground: rim_rules.h
//   CellRules   hits in a cell: cell_rules.h
//   WalkRay     ray, ground and state: walk_ray.h
#pragma once

#include <algorithm>
#include <limits>
#include <type_traits>

#include "scarp/march/height/block_rules.h"
#include "scarp/march/height/traced_visitor.h"

// Internal linkage lets the compiler inline what is used once: otherwise the state spills to memory, and rays take 10 %
// longer. For the same reason the common path through a cell is inlined, and the rare ones are not.
namespace scarp::max_mip {
namespace {

template <class T, bool Holes, bool Wraps, Ask ask>
class Walk : public BlockRules<T, Holes, Wraps, ask> {
 public:
  using Base = BlockRules<T, Holes, Wraps, ask>;

  /// Parameters: target, samples, the ray in world space and in cells, the query, and the answer. The traversal starts
  /// in the cell that contains Wanted::t_clear.
  using Base::Base;

  void run() {
    if (strict_) {
      if (!leave_start_cell()) return;
      bound_rounding();
      if (wanted_.t_clear > t_in_ && !skip_on(wanted_.t_clear)) return;
    } else {
      if (!enter()) {
        if (!Wraps && side_ != Side::unknown) follow_border_on_exit();
        return;
      }
      if (!x_.moves() && !y_.moves()) return vertical();
      if (Holes && side_ == Side::unknown && !below_rim_ && ground_.is_hole(col_, row_) && touches(t_in_)) return;
    }
    // The bounds of a block do not include the rims of adjacent blocks.
    if (Holes && !strict_ && rim(grid_ray()).slow(t_in_)) top_ = level_ = 0, slow_ = true;
    while (walk()) enter_next_copy();
    if (!Wraps) follow_border_on_exit();
  }

  /// For a ray from the surface: processes the first cell only.
  SurfaceStart start() {
    SurfaceStart start;
    start.decided = !leave_start_cell();
    start.t = t_in_;
    start.z = z_;
    start.above = side_ == Side::above;
    return start;
  }

  using Base::stats;

 private:
  using Axis = typename Base::Axis;
  // Queries that may have a trace record.
  using Visitor =
      std::conditional_t<ask == Ask::as_wanted, TracedVisitor<Base, typename Base::Visitor>, typename Base::Visitor>;
  using Base::bound_rounding, Base::grid_ray, Base::answer, Base::test_triangles, Base::falls_from_start;
  using Base::ray_height, Base::quadratic, Base::surface, Base::clearance, Base::rim, Base::is_hit;
  using Base::through_, Base::cell_end_, Base::from_outside_, Base::slow_, Base::below_rim_, Base::top_;
  using Base::touches, Base::follow_rim, Base::follow_border_on_entry, Base::follow_border_on_exit, Base::ground_;
  using Base::triangles_, Base::wanted_, Base::ray_, Base::answer_, Base::col_, Base::row_, Base::side_;
  using Base::x_, Base::y_, Base::z_, Base::dz_, Base::t_in_, Base::t_end_, Base::rounding_, Base::strict_;

  // Clips the ray to the field and to the highest sample; finds the first cell.
  bool enter() {
    if (!Wraps) {
      const double border = std::max(x_.enter_time(), y_.enter_time());
      from_outside_ = border >= t_in_;
      if (from_outside_) {
        t_in_ = border;
        through_ = x_.enter_time() == border ? Through::x_line : Through::y_line;
      }
      // A coarse block may extend beyond the last row or column; the ray's end does not.
      t_end_ = std::min({t_end_, x_.exit_time(), y_.exit_time()});
      if (!rim(grid_ray()).over_strips()) return false;
      if ((from_outside_ || !(t_in_ <= t_end_)) && follow_border_on_entry()) return false;
    }
    if (!(t_in_ <= t_end_)) return false;
    bound_rounding();
    // A ray that starts between the lowest and the highest ground is likely to start near the ground, where long skips
    // are not possible. A ray from outside crosses open air first, though blocks that span the field are rarely free.
    const int from_outside = std::max(top_ - 3, 0);
    level_ = t_in_ == ray_.t_min ? 0 : from_outside;
    const double highest = ground_.highest();
    double t_begin = wanted_.t_clear;
    if (ray_height(t_in_) > highest) {
      if (!(dz_ < 0)) return false;
      side_ = Side::above;
      // Down to the highest sample plus twice the rounding error: a touch is within the bound, and its t is rounded.
      // Not finite for an endless ray straight down, which has one cell.
      const double t_top = (highest - z_ + 2 * rounding_) / dz_;
      if (t_top > t_end_) return false;
      level_ = from_outside;
      t_begin = std::max(t_begin, t_top);
    }
    if (t_begin > t_in_) {
      if (t_begin == wanted_.t_clear) level_ = 0;
      return skip_to(t_begin);
    }
    col_ = x_.cell_after(t_in_);
    row_ = y_.cell_after(t_in_);
    return true;
  }

  // Advances to the entry of the cell that contains t, up to which the ray is above the ground, so that a peak which it
  // just touches is still ahead. Returns false if the ray ends before.
  bool skip_to(double t) {
    if (t > t_end_) return false;
    side_ = Side::above;
    col_ = x_.cell_before(t);
    row_ = y_.cell_before(t);
    t_in_ = std::max({t_in_, x_.line_time(col_ + 1 - x_.ahead), y_.line_time(row_ + 1 - y_.ahead)});
    return true;
  }

  // The same from within a cell, never to a previous one: lines beside a start on a line may count as ahead.
  bool skip_on(double t) {
    const int col = col_, row = row_;
    const double t_in = t_in_;
    if (!skip_to(t)) return false;
    if ((col_ - col) * x_.step <= 0) col_ = col;
    if ((row_ - row) * y_.step <= 0) row_ = row;
    t_in_ = t_in;
    if (col_ != col) t_in_ = std::max(t_in_, x_.line_time(col_ + 1 - x_.ahead));
    if (row_ != row) t_in_ = std::max(t_in_, y_.line_time(row_ + 1 - y_.ahead));
    return true;
  }

  // From the surface: the root at the start is divided out of the clearance in the first cell, and the rest decides.
  // Returns false if the answer is known.
  bool leave_start_cell() {
    col_ = ray_.start_cell.col;
    row_ = ray_.start_cell.row;
    if (!x_.inside(col_) || !y_.inside(row_) || (Holes && ground_.is_hole(col_, row_))) return false;
    x_.begin_in(col_, t_in_);
    y_.begin_in(row_, t_in_);
    const CellHeights h = ground_.cell(col_, row_);
    z_ = surface(h, t_in_) - dz_ * t_in_;
    if (!Wraps) t_end_ = std::min({t_end_, x_.exit_time(), y_.exit_time()});
    const double tx = x_.line_time(col_ + x_.ahead), ty = y_.line_time(row_ + y_.ahead);
    const double t_line = std::min(tx, ty);
    ++stats.cell_tests;
    note_cell(t_line, true);
    cell_end_ = t_line;
    side_ = Side::above;
    if (!x_.moves() && !y_.moves()) {
      // A ray straight down is below at once; its range may be infinite.
      if (dz_ < 0 && t_end_ > t_in_ && is_hit(dz_ * (t_end_ - t_in_), t_in_)) answer(0.0);
      return false;
    }
    if (t_line > t_in_) {
      if (triangles_) {
        const Through exit = tx <= ty ? Through::x_line : Through::y_line;
        if (test_triangles(h, clearance(h, exit, true, t_line), t_line)) return false;
      } else if (falls_from_start(quadratic(h, t_in_), t_line - t_in_)) {
        return false;
      }
    }
    level_ = 0;
    t_in_ = t_line;
    after_x_ = tx <= ty;
    if (!(t_in_ < t_end_)) return false;
    if (Holes) through_ = after_x_ ? Through::x_line : Through::y_line;
    Axis& axis = after_x_ ? x_ : y_;
    int& cell = after_x_ ? col_ : row_;
    cell += axis.step;
    if (!axis.inside(cell)) {
      if (!Wraps) return false;
      cell = axis.enter_next_copy();
    }
    return true;
  }

  // Straight up or down: one cell, one height, wherever the range ends.
  void vertical() {
    ++stats.steps;
    note_cell(t_end_, !Holes || !ground_.is_hole(col_, row_));
    if (Holes && ground_.is_hole(col_, row_)) {
      follow_rim(t_in_, std::numeric_limits<double>::infinity(), {col_ - 1, col_ + 1, row_ - 1, row_ + 1});
      return;
    }
    ++stats.cell_tests;
    const double ground = surface(ground_.cell(col_, row_), t_in_), above = ray_height(t_in_) - ground;
    if (above < 0 && side_ != Side::above) {
      answer_.status = HitStatus::below;
    } else if (above <= 0) {
      answer(0.0);
    } else if (dz_ < 0) {
      answer((ground - z_) / dz_ - t_in_);
    }
  }

  // Records the current cell, outside the walk over blocks.
  void note_cell(double t_out, bool tested) {
    if constexpr (ask == Ask::as_wanted) {
      if (wanted_.trace) record_cell(*wanted_.trace, col_, row_, t_in_, t_out, tested);
    }
  }

  // Traverses one copy of the grid; returns true if the ray has left for the next.
  [[gnu::always_inline]] bool walk() {
    // Copies that the compiler knows to be constant.
    const Axis x = x_, y = y_;
    BlockStart start{level_, col_, row_, t_in_};
    const bool left =
        walk_blocks(x, y, top_, t_end_, ray_.t_max, start, after_x_, stats, Visitor(static_cast<Base&>(*this)));
    if (left) level_ = start.level, col_ = start.col, row_ = start.row, t_in_ = start.t_in;
    return left;
  }

  // Across the seam: as over any line, column before row. It separates blocks of all levels, so the ray moves up one
  // level.
  void enter_next_copy() {
    after_x_ = x_.exit_time() <= y_.exit_time();
    (after_x_ ? col_ : row_) = (after_x_ ? x_ : y_).enter_next_copy();
    if (Holes) through_ = after_x_ ? Through::x_line : Through::y_line;
    level_ = std::min(level_ + 1, top_);
  }

  int level_ = 0;
  bool after_x_ = false;  // whether the last line crossed was of constant column
};

}  // namespace
}  // namespace scarp::max_mip
