// SPDX-License-Identifier: MIT
// The traversal of `max-mip`, for all queries: see max_mip.h.
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "scarp/march/height/cell_surface.h"
#include "scarp/march/height/cells_beside.h"
#include "scarp/march/height/grid_axis.h"
#include "scarp/march/height/height_target.h"
#include "scarp/march/height/max_mip_rims.h"
#include "scarp/march/height/rounding.h"
#include "scarp/march/height/walk_ground.h"
#include "scarp/march/height/walk_query.h"

// Internal linkage lets the compiler inline what is used once: otherwise the state spills to memory, and rays take 10 %
// longer. For the same reason the common path through a cell is inlined, and the rare ones are not.
namespace scarp::max_mip {
namespace {

// How the ray got to its position: through a line of constant column (x) or row (y), or not through a line.
enum class Through { point, x_line, y_line };

template <class T, bool Holes, bool Wraps, Ask ask, bool UpsideDown = false>
class Walk {
 public:
  /// The traversal starts in the cell that contains Wanted::t_clear.
  Walk(const HeightTarget& target, const SampleGrid<T>& grid, const Ray& ray, const GridRay& local,
       const Wanted& wanted, Hit& answer)
      : field_(*target.field),
        seam_(target.seam),
        seam_step_(target.seam_step),
        ground_(field_, *target.pyramid, grid),
        levels_(target.pyramid->levels().data()),
        top_(target.pyramid->top_level()),
        x_(local.origin.x, local.direction.x, grid.cell_cols),
        y_(local.origin.y, local.direction.y, grid.cell_rows),
        z_(UpsideDown ? -local.origin.z : local.origin.z),
        dz_(UpsideDown ? -local.direction.z : local.direction.z),
        t_in_(ray.t_min),
        t_end_(ray.t_max),
        strict_(ray.start == RayStart::on_surface),
        triangles_(field_.settings().surface == Surface::triangles),
        solid_(field_.settings().solid && !UpsideDown),
        wanted_(wanted),
        ray_(ray),
        answer_(answer) {}

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
    // Blocks do not have the rims of those beside them.
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

  MarchStats stats;

 private:
  using Axis = GridAxis<Wraps>;

  double ray_height(double t) const { return z_ + dz_ * t; }

  CellQuadratic quadratic(const CellHeights& h, double t) const {
    return {h, x_.place(t, col_), y_.place(t, row_), x_.direction, y_.direction, ray_height(t), dz_};
  }
  CellPlane plane(const CellHeights& h, bool south_east, double t) const {
    return {h, south_east, x_.place(t, col_), y_.place(t, row_), x_.direction, y_.direction, ray_height(t), dz_};
  }
  bool south_east(double t) const { return x_.place(t, col_) + y_.place(t, row_) > 1; }

  // Height of the surface under a point of the ray in the current cell.
  double surface(const CellHeights& h, double t) const {
    return triangles_ ? plane(h, south_east(t), t).surface : quadratic(h, t).surface;
  }

  // Clearance where the ray enters or leaves the current cell: at a line, of the same two nodes for both neighbours.
  double clearance(const CellHeights& h, Through through, bool leaving, double t) const {
    switch (through) {
      case Through::x_line: {
        const bool high = (x_.ahead == 1) == leaving;
        return ray_height(t) - edge_height(high ? h.h10 : h.h00, high ? h.h11 : h.h01, y_.place(t, row_));
      }
      case Through::y_line: {
        const bool high = (y_.ahead == 1) == leaving;
        return ray_height(t) - edge_height(high ? h.h01 : h.h00, high ? h.h11 : h.h10, x_.place(t, col_));
      }
      case Through::point:
        break;
    }
    return ray_height(t) - surface(h, t);
  }

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
      // Down to the highest sample and what rounding may add to it, twice: a touch is within the bound, and its t is
      // rounded. Not finite for a ray straight down without an end, which has one cell.
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

  // Advances to the start of the cell with a time up to which the ray is above the ground, so that a peak which it just
  // touches is still ahead. Returns false if the ray ends before.
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
    cell_end_ = t_line;
    side_ = Side::above;
    if (!x_.moves() && !y_.moves()) {
      // Straight down is below at once; the range may be infinite.
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

  // The bilinear cell in which a ray starts on the surface: f(s) = s (a s + b) is below right after the start, or after
  // the second root, if anywhere by more than rounding. Returns true if the answer is known.
  bool falls_from_start(const CellQuadratic& f, double length) {
    const bool dips = f.a > 0 && f.b < 0 && -f.b < 2 * f.a * length;
    const double last = length * (f.a * length + f.b), lowest = dips ? -f.b * f.b / (4 * f.a) : last;
    if (!(lowest < 0 && is_hit(lowest, t_in_))) return false;
    if (answer(f.b < 0 || f.a == 0 ? 0.0 : f.b / -f.a)) return true;
    if (last <= rounding_of_clearance(t_in_ + length)) side_ = Side::below;
    return false;
  }

  // Returns whether a ray that is above at t is, at some later point, below a whole block: without holes it has crossed
  // the surface before. Samples the minima of one level, which fits in a cache, at growing steps; rays along the ground
  // are mostly stopped by hills that are wider than a block.
  bool goes_under(double t) {
    if (Wraps || top_ < kProbeLevel) return false;
    const MaxPyramid::Level& at = levels_[kProbeLevel - 1];
    const double t_last = dz_ > 0 ? std::min(t_end_, (ground_.highest() - z_) / dz_) : t_end_;
    const double t_per_cell = 1 / std::max(std::abs(x_.direction), std::abs(y_.direction));
    if (!(t_last - t > kShortWay * t_per_cell)) return false;
    const double code_z = (z_ - ground_.base()) * ground_.per_step(), code_dz = dz_ * ground_.per_step();
    double step = kFirstProbe * t_per_cell;
    for (int i = 0; i < kProbes; ++i) {
      t += step;
      step *= kProbeGrowth;
      if (!(t < t_last)) return false;
      const std::ptrdiff_t row = y_.near(y_.at(t)) >> kProbeLevel, col = x_.near(x_.at(t)) >> kProbeLevel;
      const std::uint16_t minimum = ground_.minimum(at.begin + row * at.cols + col);
      // The position is rounded, too, and that of the next block equally valid: the bound covers it.
      if (code_z + code_dz * t < minimum && falls_under(minimum, t)) {
        answer_.status = HitStatus::hit;
        return true;
      }
    }
    return false;
  }

  // Straight up or down: one cell, one height, wherever the range ends.
  void vertical() {
    ++stats.steps;
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

  // Traverses one copy of the grid (coarse blocks may extend beyond it); returns true if the ray has left for the next.
  // Keeps, in locals, the block at the current level and the times at which the ray leaves it through its two far
  // lines. Descending one level only compares the time of the middle line. No cell is ever computed from a position.
  bool walk() {
    const bool falling = dz_ < 0;
    const Axis x = x_, y = y_;
    // The ray's height as a code, minus the maximum rounding error: compared with the pyramid without decoding it.
    const double per_step = ground_.per_step(), highest = ground_.highest(), base = ground_.base();
    const double farthest = std::max(std::abs(t_in_), std::abs(t_end_));
    const double upright = std::abs(z_) + std::abs(dz_) * farthest + std::abs(base) + std::abs(highest);
    const double rounding = ground_.kRoundingOfCode * upright + rounding_;
    const double code_z = (z_ - base - rounding) * per_step, code_dz = dz_ * per_step;
    const double highest_code = (highest - base) * per_step;
    const double t_exit = std::min(x.exit_time(), y.exit_time()), t_end = Wraps ? std::min(t_end_, t_exit) : t_end_;
    int level = level_, col = col_ >> level, row = row_ >> level;
    double t_in = t_in_, tx = x.line_time((col + x.ahead) << level), ty = y.line_time((row + y.ahead) << level);
    const double beside_node = Holes ? widest_rounding_of_line(field_, grid_ray(), seam_) : 0;
    const double at_node[] = {Holes ? rim(grid_ray()).beside_node(0) : 0, Holes ? rim(grid_ray()).beside_node(1) : 0};
    // Passing the corner of a hole or block, in over one line and out over the other, does not leave the ground.
    const auto cuts_corner = [&](bool out_over_x, double begin, double end) {
      if (through_ != (out_over_x ? Through::y_line : Through::x_line)) return end <= begin;
      return (end - begin) * std::abs(out_over_x ? y.direction : x.direction) <= beside_node;
    };
    std::uint32_t steps = 0, level_changes = 0;
    bool left = false;
    for (;;) {
      const bool through_x = tx <= ty;  // a tie: the line of constant column first
      const double t_line = through_x ? tx : ty;
      const double t_out = std::min(t_line, t_end);
      // The ray's height is linear: lowest at one end of the block. Over a block with holes the whole way counts, so
      // that the end of the range does not decide whether the rim behind its first line is followed.
      const double t_leave = std::min(t_line, t_exit);
      const double t_lowest = falling ? Holes ? t_leave : t_out : t_in, lowest_code = code_z + code_dz * t_lowest;
      ++steps;
      if (level > 0) {
        const MaxPyramid::Level& at = levels_[level - 1];
        const std::ptrdiff_t entry = at.begin + static_cast<std::ptrdiff_t>(row) * at.cols + col;
        const std::uint16_t maximum = ground_.maximum(entry);
        if (lowest_code > maximum && (side_ != Side::below || risen_above(maximum, t_lowest))) {
          // There may be ground behind the line that it crossed, with a node that the ray passes.
          if (Holes && begun_ && side_ != Side::below && !below_rim_ &&
              passes_node(after_x_ ? y.at(t_in) : x.at(t_in), at_node[!after_x_]) &&
              touches(rim(grid_ray()).node_time(t_in, !after_x_, t_leave)))
            break;
          // With holes, the last cell may be one: the side is unknown at the next.
          if (!Holes) {
            side_ = Side::above;
          } else if (!cuts_corner(through_x, t_in, t_leave)) {
            side_ = Side::unknown;
          }
        } else if (side_ == Side::below && under(ray_height(falling ? t_in : t_out), ground_.minimum(entry))) {
          if (lost(t_out)) break;
        } else {
          if (ask == Ask::any && falling && side_ == Side::above && falls_under(ground_.minimum(entry), t_out)) {
            answer_.status = HitStatus::hit;
            break;
          }
          --level;
          ++level_changes;
          // After a line of constant column, row lines with the same time are still ahead: the order of ties. The near
          // side of a narrow last block is the seam, which has been crossed already.
          const double middle_x = x.line_time((2 * col + 1) << level), middle_y = y.line_time((2 * row + 1) << level);
          const bool entered = Wraps && !y.ahead && ((2 * row + 1) << level) >= y.cells;
          const bool behind_x = middle_x <= t_in, behind_y = after_x_ && !entered ? middle_y < t_in : middle_y <= t_in;
          col = std::min(2 * col + (behind_x ? x.ahead : 1 - x.ahead), (x.cells - 1) >> level);
          row = std::min(2 * row + (behind_y ? y.ahead : 1 - y.ahead), (y.cells - 1) >> level);
          tx = behind_x ? tx : middle_x;
          ty = behind_y ? ty : middle_y;
          continue;
        }
      } else if (Holes && ground_.is_hole(col, row)) {
        const bool corner = cuts_corner(through_x, t_in, t_line);
        // A ray beside no ground keeps its side only if it stays above all ground.
        const bool stays = corner && std::min(ray_height(t_in), ray_height(t_line)) > highest;
        const auto follow = [&] { return follow_rim(t_in, t_line, {col - 1, col + 1, row - 1, row + 1}, stays); };
        if (slow_ ? follow()
                  : begun_ && side_ != Side::below && (touches(t_in) || (sinks_over_rim(t_in) && follow()))) {
          break;
        }
        if (!slow_ && !corner) side_ = Side::unknown, below_rim_ = false;
        if (lost(t_in)) break;
      } else {
        const CellHeights h = ground_.cell(col, row);
        const double maximum = std::max(std::max(h.h00, h.h10), std::max(h.h01, h.h11));
        // A hit does not depend on where the ray ends: its whole cell is tested.
        const double t_low = falling ? t_leave : t_in, lowest = ray_height(t_low);
        if (lowest > maximum && (side_ != Side::below || lowest - maximum > rounding_of_clearance(t_low))) {
          side_ = Side::above;
        } else {
          col_ = col, row_ = row, t_in_ = t_in;
          if (test_cell(h, through_x, t_line, t_leave)) break;
        }
      }
      if (Holes) {
        if (side_ != Side::below && !below_rim_ && t_line <= t_end &&
            passes_node(through_x ? y.at(t_line) : x.at(t_line), beside_node) && touches(t_line))
          break;
        begun_ = true;
      }
      if (!falling && lowest_code > highest_code) break;
      // The range is closed: the cell behind the line on which it ends may have the hit.
      if (!(t_line < t_end) && !(t_line == ray_.t_max && t_line < t_exit)) {
        left = t_end < t_end_ || (Wraps && t_exit == t_end_);
        // A line of constant column crossed together with the seam of the rows comes first, too.
        const bool another_column =
            static_cast<unsigned>(col + x.step) <= static_cast<unsigned>((x.cells - 1) >> level);
        if (!(left && through_x && t_line == t_end && another_column)) break;
        left = false;
      }
      t_in = t_line;
      if (ask == Ask::any && !Holes && steps == kPatience && side_ == Side::above && goes_under(t_in)) break;
      after_x_ = through_x;
      if (Holes) through_ = through_x ? Through::x_line : Through::y_line;
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
      if (new_parent && level < top_) {
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
    if (left) {
      t_in_ = t_end;
      level_ = level;
      col_ = std::min(col << level, x.cells - 1);
      row_ = std::min(row << level, y.cells - 1);
    }
    return left;
  }

  // Across the seam: as over any line, column before row. It separates blocks of all levels, so one level up.
  void enter_next_copy() {
    after_x_ = x_.exit_time() <= y_.exit_time();
    (after_x_ ? col_ : row_) = (after_x_ ? x_ : y_).enter_next_copy();
    if (Holes) through_ = after_x_ ? Through::x_line : Through::y_line;
    level_ = std::min(level_ + 1, top_);
  }

  // Whether a ray that was below is above a whole block by more than rounding: see test_cell().
  bool risen_above(std::uint16_t maximum, double t_lowest) const {
    return ray_height(t_lowest) - ground_.height(maximum) > rounding_of_clearance(t_lowest);
  }

  // Whether a ray that is below stays below over a whole block, which then has no holes.
  bool under(double highest, std::uint16_t minimum) const {
    return minimum != MaxPyramid::kNoMinimum && highest < ground_.height(minimum);
  }

  // Whether a ray that was above is at t, over a block without holes, below it: it has crossed the surface. By more
  // than rounding, so that closest() finds the hit, too.
  bool falls_under(std::uint16_t minimum, double t) const {
    const double height = ray_height(t);
    return under(height, minimum) && ground_.height(minimum) - height > 2 * rounding_of_clearance(t);
  }

  // Tests the surface of the current cell, up to the line that ends it, or the border before that. Returns true if the
  // answer is known; otherwise side_ is that of the exit.
  [[gnu::always_inline]] bool test_cell(const CellHeights& h, bool through_x, double t_line, double t_out) {
    ++stats.cell_tests;
    cell_end_ = t_out;
    if (strict_) {
      // The ray is in the given start cell; by rounding, surrounding lines may be crossed before it starts, since its
      // place is clamped and its height must not run ahead.
      t_in_ = std::max(t_in_, ray_.t_min);
      t_out = std::max(t_out, ray_.t_min);
    }
    if (side_ == Side::unknown && find_side(h)) return true;
    const Through exit = t_line > t_out ? Through::point : through_x ? Through::x_line : Through::y_line;
    const double out = clearance(h, exit, true, t_out);
    return triangles_ ? test_triangles(h, out, t_out) : test_bilinear(h, out, t_out);
  }

  // Whether a ray that is not below the ground touches it at t, on a line. Returns true if that is the answer.
  [[gnu::noinline]] bool touches(double t) {
    if (strict_) return false;
    const auto record = [&](int col, int row, const dvec2& place) { return touch(col, row, t, place); };
    return rim(grid_ray()).touched_at(t, accepts(), record);
  }

  // Whether a ray from over the ground may sink through its rim behind the line that it crosses at t.
  [[gnu::noinline]] bool sinks_over_rim(double t) const {
    return !strict_ && side_ == Side::above && rim(grid_ray()).may_sink(t, through_ == Through::x_line ? 0 : 1);
  }

  // Records a touch at t, at a given place of a cell, which need not be on the ray's way. In lists of all hits, those
  // of neighbours that share the place count as one. Returns true if the query is answered.
  bool touch(int col, int row, double t, const dvec2& place) {
    side_ = Side::below;
    if (lists() && !wanted_.all->empty() &&
        t - wanted_.all->back().t <= rounding_of_node_time(field_, grid_ray(), seam_))
      return false;
    const int on_way_col = std::exchange(col_, col), on_way_row = std::exchange(row_, row);
    const double on_way_t = std::exchange(t_in_, t);
    const bool answered = answer(0.0, false, &place);
    col_ = on_way_col, row_ = on_way_row, t_in_ = on_way_t;
    return answered;
  }

  // Follows the ray beside the ground, during a time in which it is over none; its side is then that at the end, unless
  // it must stay. Returns true if the query is answered.
  [[gnu::noinline]] bool follow_rim(double begin, double end, const RimBox& box, bool stay = false,
                                    bool goes_in = false) {
    RimSide at{below_rim_ ? Side::below : side_, below_rim_ || side_ == Side::unknown};
    const auto record = [&](const RimStretch& s, double t, const dvec2& place) {
      return touch(x_.within(s.col), y_.within(s.row), t, place);
    };
    if (rim(grid_ray()).follow(begin, end, box, goes_in, at, record)) return true;
    if (stay && at.side == Side::unknown) return false;
    side_ = at.came ? Side::unknown : at.side;
    below_rim_ = at.came && at.side == Side::below;
    return false;
  }
  [[gnu::noinline]] bool follow_border(double begin, double end, bool goes_in) {
    const auto beside = rim(grid_ray());
    begin = std::max(begin, ray_.t_min);
    if (begin > ray_.t_max) return false;
    return beside.may_touch(begin, end) && follow_rim(begin, end, beside.cells_under(begin, end), false, goes_in);
  }
  // Before the ray is over the field, or all the time if it never is. A ray from the surface does not enter.
  bool follow_border_on_entry() {
    const bool goes_in = t_in_ <= std::min(x_.exit_time(), y_.exit_time());  // wherever the range ends
    return follow_border(rim(grid_ray()).first_time(), goes_in ? t_in_ : rim(grid_ray()).last_time(), goes_in);
  }
  void follow_border_on_exit() {
    if (strict_ || (!lists() && answer_) || (side_ == Side::unknown && !begun_)) return;
    follow_border(std::min(x_.exit_time(), y_.exit_time()), rim(grid_ray()).last_time(), false);
  }
  Rim<T, Wraps, UpsideDown> rim(const GridRay& ray) const { return {field_, ground_, x_, y_, ray, seam_, seam_step_}; }

  // Determines the side of the ray; returns true if that is the answer. No previous crossing has to agree. A ray that
  // crosses a rim within rounding of it touches it, for either sign: otherwise a ray through the corner of a hole,
  // above on one side, could be below on the other.
  [[gnu::noinline]] bool find_side(const CellHeights& h) {
    const double in = clearance(h, through_, false, t_in_);
    const int axis = through_ == Through::point ? -1 : through_ == Through::x_line ? 0 : 1;
    const bool on_rim =
        !below_rim_ && in <= 0 && -in <= rim(grid_ray()).rounding_at(t_in_, relief(h), axis, Holes && begun_, slow_);
    if (on_rim && !strict_) {
      side_ = Side::below;
      return answer(0.0);
    }
    // A ray that has sunk below the rim has emerged only if it is above by more than rounding.
    const double risen = std::exchange(below_rim_, false) ? rounding_of_clearance(t_in_) : 0.0;
    side_ = (risen > 0 ? in > risen : in >= 0) || on_rim ? Side::above : Side::below;
    if (side_ == Side::above) return false;
    if (solid_ && (begun_ || from_outside_)) return rim(grid_ray()).overflows(t_in_) || answer(0.0, true);
    if (!begun_ && answer_.status == HitStatus::miss) answer_.status = HitStatus::below;
    return false;
  }

  [[gnu::always_inline]] bool test_bilinear(const CellHeights& h, double out, double t_out) {
    const double length = t_out - t_in_;
    if (side_ == Side::above) {
      if (out <= 0 && is_hit(out, t_out)) {
        if (hit_in_cell(quadratic(h, t_in_), length)) return true;
        side_ = Side::below;
        return lost(t_out);
      }
      if (bisects()) return false;
      // Only if the clearance along the ray is convex can the ray come down and go up again.
      if (!(CellQuadratic::curvature(h, x_.direction, y_.direction) > 0)) return false;
      const CellQuadratic f = quadratic(h, t_in_);
      if (!f.dips(length) || !is_hit(f.vertex_value(), t_in_)) return false;
      if (hit_in_cell(f, length)) return true;
      // All hits: after this one it has risen only beyond rounding, like any ray from below.
      if (out <= rounding_of_clearance(t_out)) side_ = Side::below;
      return false;
    }
    if (out > rounding_of_clearance(t_out)) {
      side_ = Side::above;
      return false;
    }
    if (bisects()) return false;
    const CellQuadratic f = quadratic(h, t_in_);
    if (f.peaks(length) && f.vertex_value() > rounding_of_clearance(t_in_)) {
      // The ray has emerged in between and continues like any ray from above.
      side_ = Side::above;
      if (!(out <= 0 && is_hit(out, t_out))) return false;
      if (hit_in_cell(f, length)) return true;
      side_ = Side::below;
    }
    return lost(t_out);
  }

  // Two triangles: signs at the entry, at the diagonal if crossed, and at the exit, with linear clearance in between.
  [[gnu::noinline]] bool test_triangles(const CellHeights& h, double out, double t_out) {
    const double sum = static_cast<double>(x_.global_line(col_) + y_.global_line(row_) + 1);
    const double t_diagonal = (sum - (x_.origin + y_.origin)) / (x_.direction + y_.direction);
    double t_begin = t_in_;
    // A ray parallel to the diagonal never crosses it: the quotient is infinite or NaN.
    if (t_diagonal > t_in_ && t_diagonal < t_out) {
      const double crossing = ray_height(t_diagonal) - edge_height(h.h10, h.h01, y_.place(t_diagonal, row_));
      if (test_triangle(h, t_begin, crossing, t_diagonal)) return true;
      t_begin = t_diagonal;
    }
    return test_triangle(h, t_begin, out, t_out) || (side_ == Side::below && lost(t_out));
  }

  // One triangle, from t_begin, where side_ gives the sign, to t_out. Returns true if the answer is known.
  bool test_triangle(const CellHeights& h, double t_begin, double out, double t_out) {
    if (side_ == Side::below) {
      if (out > rounding_of_clearance(t_out)) side_ = Side::above;
      return false;
    }
    if (!(out <= 0 && is_hit(out, t_out))) return false;
    side_ = Side::below;
    if (ask == Ask::any && cell_end_ <= ray_.t_max) return answer(0.0);
    const CellPlane f = plane(h, south_east(0.5 * (t_begin + t_out)), t_begin);
    const double s = f.c > 0 ? f.root() : 0.0;
    return answer(t_begin - t_in_ + (s >= 0 ? std::min(s, t_out - t_begin) : t_out - t_begin));
  }

  // The query, a compile-time constant except for Ask::as_wanted.
  bool lists() const { return ask == Ask::as_wanted && wanted_.all; }
  bool bisects() const { return ask == Ask::as_wanted && wanted_.bisects; }
  bool accepts() const { return ask == Ask::as_wanted && !lists() && !bisects(); }

  // Whether a ray that is not above can never hit again: falling, below the lowest ground, with no walls of holes
  // ahead.
  bool lost(double t) const { return dz_ < 0 && ray_height(t) < ground_.lowest() && !(Holes && solid_); }

  // Where a sign alone is not enough: a ray from below has risen only beyond it (otherwise one that rises through a
  // node could be above at one line and, by rounding, not above at the next: a hit from below), a ray from the surface
  // is strictly below only beyond it, and so is a ray under a block.
  double rounding_of_clearance(double t) const { return scarp::rounding_of_clearance(field_, grid_ray(), t); }
  // The bound for the whole ray, from t_in_ on.
  void bound_rounding() { rounding_ = rounding_of_clearance(std::max(std::abs(t_in_), std::abs(t_end_))); }
  GridRay grid_ray() const { return {{x_.origin, y_.origin, z_}, {x_.direction, y_.direction, dz_}}; }

  // A clearance <= 0 is a hit; rays that start on the surface require < -rounding.
  bool is_hit(double clearance, double t) const { return !strict_ || clearance < -rounding_of_clearance(t); }

  // The signs imply a hit in the cell; the quadratic only locates it.
  bool hit_in_cell(const CellQuadratic& f, double length) {
    if (ask == Ask::any && cell_end_ <= ray_.t_max) return answer(0.0);
    if (bisects()) {
      double low = 0, high = length;
      for (int i = 0; i < wanted_.halvings; ++i) {
        const double middle = 0.5 * (low + high);
        (f.at(middle) > 0 ? low : high) = middle;
      }
      return answer(high);
    }
    const double s = f.falling_root();
    return answer(s >= 0 ? std::min(s, length) : 0.0);
  }

  // Records a hit at t_in + s in the current cell, unless the ray ends before; returns true if the query is answered.
  // `place`: its place in the cell, if not that of the ray.
  bool answer(double s, bool wall = false, const dvec2* place = nullptr) {
    const double t = std::max(s > 0 ? std::min(t_in_ + s, cell_end_) : t_in_ + s, ray_.t_min);
    // From the surface, the ray is below it only after t.
    if (strict_ ? t >= ray_.t_max : t > ray_.t_max) return !lists();
    const HitStatus before = std::exchange(answer_.status, HitStatus::hit);
    if constexpr (ask == Ask::any) return true;
    answer_.t = t;
    answer_.cell = {col_, row_};
    assert(bisects() || rim(grid_ray()).is_height_of_ground(t, wall));
    answer_.u = place ? place->x : x_.place(t, col_);
    answer_.v = place ? place->y : y_.place(t, row_);
    answer_.height = ground_.metres(ray_height(t));
    answer_.wall = wall;
    if (lists()) wanted_.all->push_back(answer_);
    if (accepts() && wanted_.accept && !(*wanted_.accept)(answer_)) {
      answer_ = {};
      answer_.status = before;
      return false;
    }
    return !lists();
  }

  const HeightField& field_;
  double seam_, seam_step_;
  const WalkGround<T, UpsideDown> ground_;
  const MaxPyramid::Level* levels_;
  int top_;
  Axis x_, y_;
  double z_, dz_;  // ray height in sample units
  double t_in_, t_end_;
  double rounding_ = 0;  // of the clearance: bound_rounding()
  bool strict_, triangles_, solid_;
  const Wanted wanted_;
  const Ray& ray_;

  int col_ = 0, row_ = 0;  // the current cell: this is the state, times are derived from it
  int level_ = 0;
  Side side_ = Side::unknown;
  Through through_ = Through::point;
  bool after_x_ = false;                                       // whether the last line crossed was of constant column
  double cell_end_ = std::numeric_limits<double>::infinity();  // when the ray leaves the current cell
  bool from_outside_ = false;                                  // whether the ray entered through the border
  bool begun_ = false;      // with holes: whether a cell has been left; only in the first one can the ray start below
  bool slow_ = false;       // with holes: whether rims are followed
  bool below_rim_ = false;  // whether it has sunk below the adjacent rim, from outside or over a hole
  Hit& answer_;
};

}  // namespace
}  // namespace scarp::max_mip
