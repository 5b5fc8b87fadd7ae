// SPDX-License-Identifier: MIT
// The traversal of blocks of `max-mip`: which blocks of the pyramid a ray passes, and when.
//
//   over a block: pass it, and try the parent from an odd block on          block -> visitor.block()
//   not over it: descend into the child that the ray is in                  cell  -> visitor.cell()
//
// Keeps the times at which the ray leaves the current block through its two far lines. Descending one level only
// compares the time of the middle line. No cell is ever computed from a position.
#pragma once

#include <algorithm>
#include <cstdint>

#include "scarp/base/ray.h"
#include "scarp/march/height/grid_axis.h"

namespace scarp::max_mip {

/// 2^level x 2^level cells; level 0: a cell.
struct Block {
  int level, col, row;
};

/// The part of a ray that is over a block.
struct BlockWay {
  double t_in;     ///< when it enters
  double t_line;   ///< when it crosses the first of the two far lines, which may be beyond the grid
  double t_leave;  ///< the same, or when it leaves the grid
  double t_out;    ///< the same, or when its range ends
  bool through_x;  ///< whether that line is of constant column: it is first if the ray crosses both at once
  bool after_x;    ///< whether the previous line, if any, was of constant column
};

enum class Verdict { pass, descend, stop };

/// Where a traversal starts: in the block of `level` that contains a cell, at t_in. Receives where the traversal ends
/// if that is at the seam of a wrapped grid.
struct BlockStart {
  int level, col, row;
  double t_in;
};

/// Traverses one copy of the grid; coarse blocks may extend beyond it. Returns true if the ray has left for the next
/// copy, at start.t_in. `t_last`: the end of the ray's range, within the grid or not; `t_max`: its end as given. The
/// visitor decides:
///
///   Verdict block(const Block&, const BlockWay&)                   of a block of level 1 or more
///   bool cell(int col, int row, const BlockWay&)                   true: stop
///   bool leaves(const BlockWay&)                                   after the two, unless they stop; true: stop
///   bool crosses(const BlockWay&, std::uint32_t steps)             before the next block; true: stop
template <bool Wraps, class Visitor>
[[gnu::always_inline]] inline bool walk_blocks(const GridAxis<Wraps>& x, const GridAxis<Wraps>& y, int top,
                                               double t_last, double t_max, BlockStart& start, bool& after_x,
                                               MarchStats& stats, const Visitor& visitor) {
  const double t_exit = std::min(x.exit_time(), y.exit_time()), t_end = Wraps ? std::min(t_last, t_exit) : t_last;
  int level = start.level, col = start.col >> level, row = start.row >> level;
  double t_in = start.t_in, tx = x.line_time((col + x.ahead) << level), ty = y.line_time((row + y.ahead) << level);
  bool left = false;
  std::uint32_t steps = 0, level_changes = 0;
  for (;;) {
    const bool through_x = tx <= ty;
    const double t_line = through_x ? tx : ty;
    const BlockWay way{t_in, t_line, std::min(t_line, t_exit), std::min(t_line, t_end), through_x, after_x};
    ++steps;
    if (level > 0) {
      const Verdict verdict = visitor.block({level, col, row}, way);
      if (verdict == Verdict::stop) break;
      if (verdict == Verdict::descend) {
        --level;
        ++level_changes;
        // After a line of constant column, row lines with the same time are still ahead: the order of ties. The near
        // side of a narrow last block is the seam, which has been crossed already.
        const double middle_x = x.line_time((2 * col + 1) << level), middle_y = y.line_time((2 * row + 1) << level);
        const bool entered = Wraps && !y.ahead && ((2 * row + 1) << level) >= y.cells;
        const bool behind_x = middle_x <= t_in, behind_y = after_x && !entered ? middle_y < t_in : middle_y <= t_in;
        col = std::min(2 * col + (behind_x ? x.ahead : 1 - x.ahead), (x.cells - 1) >> level);
        row = std::min(2 * row + (behind_y ? y.ahead : 1 - y.ahead), (y.cells - 1) >> level);
        tx = behind_x ? tx : middle_x;
        ty = behind_y ? ty : middle_y;
        continue;
      }
    } else if (visitor.cell(col, row, way)) {
      break;
    }
    if (visitor.leaves(way)) break;
    // The range is closed: the cell behind the line on which it ends may have the hit.
    if (!(t_line < t_end) && !(t_line == t_max && t_line < t_exit)) {
      left = t_end < t_last || (Wraps && t_exit == t_last);
      // A line of constant column crossed together with the seam of the rows comes first, too.
      const bool another_column = static_cast<unsigned>(col + x.step) <= static_cast<unsigned>((x.cells - 1) >> level);
      if (!(left && through_x && t_line == t_end && another_column)) break;
      left = false;
    }
    t_in = t_line;
    if (visitor.crosses(way, steps)) break;
    after_x = through_x;
    bool new_parent;
    if (through_x) {
      col += x.step;
      if (static_cast<unsigned>(col) > static_cast<unsigned>((x.cells - 1) >> level)) break;
      new_parent = (col & 1) != x.ahead;
    } else {
      row += y.step;
      if (static_cast<unsigned>(row) > static_cast<unsigned>((y.cells - 1) >> level)) break;
      new_parent = (row & 1) != y.ahead;
    }
    if (new_parent && level < top) {
      ++level;
      ++level_changes;
      col >>= 1;
      row >>= 1;
      tx = x.line_time((col + x.ahead) << level);
      ty = y.line_time((row + y.ahead) << level);
    } else if (through_x) {
      tx = x.line_time((col + x.ahead) << level);
    } else {
      ty = y.line_time((row + y.ahead) << level);
    }
  }
  stats.steps += steps;
  stats.level_changes += level_changes;
  if (left) start = {level, std::min(col << level, x.cells - 1), std::min(row << level, y.cells - 1), t_end};
  return left;
}

}  // namespace scarp::max_mip
