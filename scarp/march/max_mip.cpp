// SPDX-License-Identifier: MIT
#include "scarp/march/max_mip.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scarp/march/grid_axis.h"

namespace scarp {
namespace {

// What is done in a cell that the ray hits.
enum class Refine { closed_form, bisect, none };

double lerp(double a, double b, double f) { return a + f * (b - a); }

// The height of a crossing between two nodes. Rounding must not lift it above the higher one: the pyramid bounds the
// nodes.
double edge_height(double a, double b, double f) {
  return std::min(lerp(a, b, std::clamp(f, 0.0, 1.0)), std::max(a, b));
}

// (ray height - surface height) along the ray inside one bilinear cell: f(s) = a s^2 + b s + c, s = t - t_in.
struct CellQuadratic {
  double a, b, c;
  double surface;  // height at s = 0

  CellQuadratic(const CellHeights& h, double u, double v, double du, double dv, double z, double dz) {
    const double hu = h.h10 - h.h00, hv = h.h01 - h.h00, twist = (h.h11 - h.h01) - hu;
    a = curvature(h, du, dv);
    b = dz - (hu * du + hv * dv + twist * (u * dv + v * du));
    surface = h.h00 + hu * u + hv * v + twist * u * v;
    c = z - surface;
  }

  static double curvature(const CellHeights& h, double du, double dv) {
    return ((h.h10 - h.h00) - (h.h11 - h.h01)) * du * dv;
  }

  double at(double s) const { return (a * s + b) * s + c; }

  // The root that a ray going downwards through zero meets: where f falls. Without cancellation, as in Ramsey et al.
  // 2004.
  double falling_root() const {
    const double root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
    return b < 0 ? 2 * c / (root - b) : -(b + root) / (2 * a);
  }
  // Starting and ending above zero in [0, length]: whether it comes down to zero in between.
  bool dips(double length) const { return a > 0 && b < 0 && -b < 2 * a * length && b * b >= 4 * a * c; }
  double vertex_value() const { return c - b * b / (4 * a); }
  // Whether it has its highest point in between.
  bool peaks(double length) const { return a < 0 && b > 0 && b < -2 * a * length; }
};

// Where the ray is, as far as known, at the entry of the current cell. Without holes it is unknown in the first cell
// only.
enum class Side { unknown, above, below };

// How the ray came to where it is: through a line of constant column (x) or row (y), or not through a line.
enum class Through { point, x_line, y_line };

template <class T, bool Holes, Refine refine>
class Walk {
 public:
  Walk(const HeightField& field, const SampleGrid<T>& grid, const MaxPyramid& pyramid, const Ray& ray,
       const GridRay& local, int halvings, Hit& answer)
      : field_(field),
        grid_(grid),
        levels_(pyramid.levels().data()),
        top_(pyramid.top_level()),
        maxima_(pyramid.level<T>(1).data),
        x_(local.origin.x, local.direction.x, grid.cols - 1),
        y_(local.origin.y, local.direction.y, grid.rows - 1),
        z_(local.origin.z),
        dz_(local.direction.z),
        t_in_(ray.t_min),
        t_end_(ray.t_max),
        strict_(ray.start == RayStart::on_surface),
        halvings_(halvings),
        ray_(ray),
        answer_(answer) {}

  void run() {
    if (strict_) {
      if (!leave_start_cell()) return;
    } else {
      if (!enter()) return;
      if (!x_.moves() && !y_.moves()) return vertical();
    }
    return walk();
  }

  MarchStats stats;

 private:
  double ray_height(double t) const { return z_ + dz_ * t; }

  CellHeights heights(int col, int row) const {
    const T *north = grid_.row(row) + col, *south = north + grid_.row_stride;
    return {static_cast<double>(north[0]), static_cast<double>(north[1]), static_cast<double>(south[0]),
            static_cast<double>(south[1])};
  }

  CellQuadratic quadratic(const CellHeights& h, double t) const {
    return {h,
            std::clamp(x_.at(t) - col_, 0.0, 1.0),
            std::clamp(y_.at(t) - row_, 0.0, 1.0),
            x_.direction,
            y_.direction,
            ray_height(t),
            dz_};
  }

  // How far the ray is above the surface where it comes into or leaves the current cell. At a line, both neighbours
  // compute the same value from the same two nodes.
  double clearance(const CellHeights& h, Through through, bool leaving, double t) const {
    switch (through) {
      case Through::x_line: {
        const bool high = (x_.ahead == 1) == leaving;
        return ray_height(t) - edge_height(high ? h.h10 : h.h00, high ? h.h11 : h.h01, y_.at(t) - row_);
      }
      case Through::y_line: {
        const bool high = (y_.ahead == 1) == leaving;
        return ray_height(t) - edge_height(high ? h.h01 : h.h00, high ? h.h11 : h.h10, x_.at(t) - col_);
      }
      case Through::point:
        break;
    }
    return quadratic(h, t).c;
  }

  // Clips the ray to the field and to the highest sample; finds the first cell.
  bool enter() {
    t_in_ = std::max({t_in_, x_.enter_time(), y_.enter_time()});
    // A coarse block may reach beyond the last row or column; the ray's end does not.
    t_end_ = std::min({t_end_, x_.exit_time(), y_.exit_time()});
    // A ray along an axis is inside the strip or it is not; written so that NaN is a miss.
    const bool beside = (!x_.moves() && !(x_.origin >= 0 && x_.origin <= x_.cells)) ||
                        (!y_.moves() && !(y_.origin >= 0 && y_.origin <= y_.cells));
    if (beside || !(t_in_ <= t_end_)) return false;
    // A ray that begins between the lowest and the highest ground is likely to begin near the ground, where wide skips
    // are not to be had; one that comes from outside crosses open air first, though blocks that span the field are
    // seldom free.
    const int from_outside = std::max(top_ - 3, 0);
    level_ = t_in_ == ray_.t_min ? 0 : from_outside;
    const double highest = field_.max_sample();
    if (ray_height(t_in_) > highest) {
      if (!(dz_ < 0)) return false;
      // Down to the highest sample, less the two roundings of the quotient; from there back to where the cell begins,
      // so that a peak which the ray just touches is still ahead.
      const double quotient = (highest - z_) / dz_, t_top = quotient - 2 * kUnit * std::abs(quotient);
      if (t_top > t_end_) return false;
      side_ = Side::above;
      level_ = from_outside;
      if (t_top > t_in_) {
        col_ = x_.cell_before(t_top);
        row_ = y_.cell_before(t_top);
        t_in_ = std::max({t_in_, x_.line_time(col_ + 1 - x_.ahead), y_.line_time(row_ + 1 - y_.ahead)});
        return true;
      }
    }
    col_ = x_.cell_after(t_in_);
    row_ = y_.cell_after(t_in_);
    return true;
  }

  // A ray that begins on the surface: its height is that of the surface, the root at the start is divided out of the
  // quadratic, and what is left decides. False: answered.
  bool leave_start_cell() {
    col_ = ray_.start_cell.col;
    row_ = ray_.start_cell.row;
    if (!x_.inside(col_) || !y_.inside(row_) || (Holes && grid_.is_hole(col_, row_))) return false;
    const CellHeights h = heights(col_, row_);
    const CellQuadratic start = quadratic(h, t_in_);
    z_ = start.surface - dz_ * t_in_;
    t_end_ = std::min({t_end_, x_.exit_time(), y_.exit_time()});
    const double tx = x_.line_time(col_ + x_.ahead), ty = y_.line_time(row_ + y_.ahead);
    const double length = std::min({tx, ty, t_end_}) - t_in_;
    ++stats.cell_tests;
    if (length > 0) {
      // f(s) = s (a s + b): below right after the start, or after the second root; if anywhere by more than rounding.
      const bool dips = start.a > 0 && start.b < 0 && -start.b < 2 * start.a * length;
      const double lowest = dips ? -start.b * start.b / (4 * start.a) : length * (start.a * length + start.b);
      if (lowest < 0 && is_hit(lowest, t_in_))
        return answer(start.b < 0 || start.a == 0 ? 0.0 : start.b / -start.a), false;
    }
    side_ = Side::above;
    level_ = 0;
    t_in_ = std::min(tx, ty);
    after_x_ = tx <= ty;
    if (Holes) through_ = after_x_ ? Through::x_line : Through::y_line;
    (after_x_ ? col_ : row_) += after_x_ ? x_.step : y_.step;
    return t_in_ < t_end_ && x_.inside(col_) && y_.inside(row_);
  }

  // Straight up or down: one cell, one height.
  void vertical() {
    ++stats.steps;
    if (Holes && grid_.is_hole(col_, row_)) return;
    ++stats.cell_tests;
    const double above = quadratic(heights(col_, row_), t_in_).c, surface = ray_height(t_in_) - above;
    if (above < 0 && side_ != Side::above) {
      answer_.status = HitStatus::below;
    } else if (above <= 0) {
      answer(0.0);
    } else if (ray_height(t_end_) <= surface) {
      answer((surface - z_) / dz_ - t_in_);
    }
  }

  // The walk keeps, in locals, the block at the current level and the times at which the ray leaves it through its two
  // far lines. One level down is a question to the line in the middle: is it behind? No cell is ever found from a
  // position.
  void walk() {
    const bool falling = dz_ < 0;
    const double highest = field_.max_sample(), t_end = t_end_;
    const GridAxis x = x_, y = y_;
    int level = level_, col = col_ >> level, row = row_ >> level;
    double t_in = t_in_, tx = x.line_time((col + x.ahead) << level), ty = y.line_time((row + y.ahead) << level);
    std::uint32_t steps = 0, level_changes = 0;
    for (;;) {
      const bool through_x = tx <= ty;  // a tie: first through the line of constant column
      const double t_line = through_x ? tx : ty;
      const double t_out = std::min(t_line, t_end);
      // The ray's height is linear, and so it is after rounding: lowest at one end of the block.
      const double lowest = ray_height(falling ? t_out : t_in);
      ++steps;
      if (level > 0) {
        const Level& at = levels_[level - 1];
        const double maximum = maxima_[at.begin + static_cast<std::ptrdiff_t>(row) * at.cols + col];
        if (!above(lowest, maximum, t_in)) {
          --level;
          ++level_changes;
          // After a line of constant column, rows' lines of the same time are still ahead: the order of ties.
          const double middle_x = x.line_time((2 * col + 1) << level), middle_y = y.line_time((2 * row + 1) << level);
          const bool behind_x = middle_x <= t_in, behind_y = after_x_ ? middle_y < t_in : middle_y <= t_in;
          col = std::min(2 * col + (behind_x ? x.ahead : 1 - x.ahead), (x.cells - 1) >> level);
          row = std::min(2 * row + (behind_y ? y.ahead : 1 - y.ahead), (y.cells - 1) >> level);
          tx = behind_x ? tx : middle_x;
          ty = behind_y ? ty : middle_y;
          continue;
        }
        // Where there are holes, the last cell may be one: the next begins with a question.
        side_ = Holes ? Side::unknown : Side::above;
      } else if (Holes && grid_.is_hole(col, row)) {
        // Passing the corner of a hole is not leaving the ground.
        if (t_line > t_in) side_ = Side::unknown;
        if (lost(t_in)) break;
      } else {
        const CellHeights h = heights(col, row);
        const double maximum = std::max(std::max(h.h00, h.h10), std::max(h.h01, h.h11));
        if (above(lowest, maximum, t_in)) {
          side_ = Side::above;
        } else {
          col_ = col, row_ = row, t_in_ = t_in;
          if (test_cell(h, through_x, t_line, t_out)) break;
        }
      }
      if (Holes) begun_ = true;
      if ((!falling && lowest > highest) || !(t_line < t_end)) break;
      t_in = t_line;
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
  }

  // Whether the ray is above all of a block. One that was below has to be so by more than rounding: see test_cell().
  bool above(double lowest, double maximum, double t_in) const {
    return lowest > maximum && (side_ != Side::below || lowest - maximum > rounding_of_clearance(t_in));
  }

  // The surface of the current cell; true: answered. Otherwise side_ is that of the way out.
  bool test_cell(const CellHeights& h, bool through_x, double t_line, double t_out) {
    ++stats.cell_tests;
    if (side_ == Side::unknown) {
      const double in = clearance(h, through_, false, t_in_);
      if (in == 0 && !strict_) return answer(0.0), true;
      side_ = in >= 0 ? Side::above : Side::below;
      if (side_ == Side::below && !begun_) answer_.status = HitStatus::below;
    }
    const double length = t_out - t_in_;
    const Through exit = t_line > t_end_ ? Through::point : through_x ? Through::x_line : Through::y_line;
    const double out = clearance(h, exit, true, t_out);
    if (side_ == Side::above) {
      if (out <= 0 && is_hit(out, t_out)) return hit_in_cell(quadratic(h, t_in_), length), true;
      if constexpr (refine == Refine::bisect) return false;
      // Only where the clearance along the ray is a cup can the ray come down and go up again.
      if (!(CellQuadratic::curvature(h, x_.direction, y_.direction) > 0)) return false;
      const CellQuadratic f = quadratic(h, t_in_);
      if (f.dips(length) && is_hit(f.vertex_value(), t_in_)) return hit_in_cell(f, length), true;
      return false;
    }
    if (out > rounding_of_clearance(t_out)) {
      side_ = Side::above;
      return false;
    }
    if constexpr (refine == Refine::bisect) return false;
    const CellQuadratic f = quadratic(h, t_in_);
    if (f.peaks(length) && f.vertex_value() > rounding_of_clearance(t_in_)) return hit_in_cell(f, length), true;
    return lost(t_out);
  }

  // Whether a ray that is not above can never be so again: falling, and under the lowest ground.
  bool lost(double t) const { return dz_ < 0 && ray_height(t) < field_.min_sample(); }

  // The most that rounding can add to a clearance (doc/dev/numerics.md), for the two places where a sign alone is not
  // enough: a ray from below has risen only beyond it (else one that rises through a node could be seen above at one
  // line and, by rounding, not above at the next: a hit from below), and a ray from the surface is strictly below only
  // beyond it.
  double rounding_of_clearance(double t) const {
    const double low = field_.min_sample(), high = field_.max_sample();
    const double sideways =
        std::abs(x_.origin) + std::abs(x_.direction * t) + std::abs(y_.origin) + std::abs(y_.direction * t);
    const double upright = std::abs(z_) + std::abs(dz_ * t) + std::max(std::abs(low), std::abs(high));
    return kRoundings * kUnit * (upright + sideways * (high - low));
  }

  // Whether a clearance of zero or less is a hit: always, but for a ray from the surface, which has to be strictly
  // below.
  bool is_hit(double clearance, double t) const { return !strict_ || clearance < -rounding_of_clearance(t); }

  // The signs have decided that there is a hit in the cell; the quadratic only says where.
  void hit_in_cell(const CellQuadratic& f, double length) {
    if constexpr (refine == Refine::bisect) {
      double low = 0, high = length;
      for (int i = 0; i < halvings_; ++i) {
        const double middle = 0.5 * (low + high);
        (f.at(middle) > 0 ? low : high) = middle;
      }
      answer(high);
    } else if constexpr (refine == Refine::closed_form) {
      const double s = f.falling_root();
      answer(s >= 0 ? std::min(s, length) : 0.0);
    } else {
      answer_.status = HitStatus::hit;
    }
  }

  // A hit at t_in + s in the current cell.
  void answer(double s) {
    answer_.status = HitStatus::hit;
    if constexpr (refine != Refine::none) {
      const double t = std::clamp(t_in_ + s, ray_.t_min, ray_.t_max);
      answer_.t = t;
      answer_.cell = {col_, row_};
      answer_.u = std::clamp(x_.at(t) - col_, 0.0, 1.0);
      answer_.v = std::clamp(y_.at(t) - row_, 0.0, 1.0);
      answer_.height = field_.height_from_sample(ray_height(t));
    }
  }

  using Level = MaxPyramid::Level;
  static constexpr double kUnit = 0x1p-53;  // unit roundoff of double
  static constexpr double kRoundings = 16;  // numerics.md counts 11 on the way to a clearance

  const HeightField& field_;
  const SampleGrid<T>& grid_;
  const Level* levels_;
  int top_;
  const T* maxima_;
  GridAxis x_, y_;
  double z_, dz_;  // ray height in sample units
  double t_in_, t_end_;
  bool strict_;
  int halvings_;
  const Ray& ray_;

  int col_ = 0, row_ = 0;  // the cell that the ray is in: this is the state, times are derived from it
  int level_ = 0;
  Side side_ = Side::unknown;
  Through through_ = Through::point;
  bool after_x_ = false;  // whether the last line crossed was one of constant column
  bool begun_ =
      false;  // with holes: whether anything has been left behind; only the first cell can say that the ray began below
  Hit& answer_;
};

template <Refine refine>
Hit march(const HeightTarget& target, const Ray& ray, int halvings, MarchStats* stats) {
  const HeightField& field = *target.field;
  Hit hit;
  if (stats) *stats = {};
  if (!field.has_cells() || field.all_nodata()) return hit;
  const GridRay local = field.grid_from_world(ray);
  const double longest =
      std::max({std::abs(local.direction.x), std::abs(local.direction.y), std::abs(local.direction.z)});
  if (!(longest > 0x1p-500 && longest < 0x1p500)) {
    if (!(longest > 0) || !std::isfinite(longest)) return hit;
    // A direction of extreme length is brought near 1 by a power of two, which rounds nothing; t goes back by the same.
    const int exponent = std::ilogb(longest);
    Ray scaled = ray;
    for (int axis = 0; axis < 3; ++axis) scaled.direction[axis] = std::ldexp(ray.direction[axis], -exponent);
    scaled.t_min = std::ldexp(ray.t_min, exponent);
    scaled.t_max = std::ldexp(ray.t_max, exponent);
    hit = march<refine>(target, scaled, halvings, stats);
    if (hit) hit.t = std::ldexp(hit.t, -exponent);
    return hit;
  }
  field.visit([&](const auto& grid) {
    using T = std::remove_cvref_t<decltype(grid.data[0])>;
    const auto run = [&](auto&& walk) {
      walk.run();
      if (stats) *stats = walk.stats;
    };
    if (grid.has_holes) {
      run(Walk<T, true, refine>(field, grid, *target.pyramid, ray, local, halvings, hit));
    } else {
      run(Walk<T, false, refine>(field, grid, *target.pyramid, ray, local, halvings, hit));
    }
  });
  return hit;
}

}  // namespace

Hit march_max_mip(const HeightTarget& target, const Ray& ray, const MarchSettings&, MarchStats* stats) {
  return march<Refine::closed_form>(target, ray, 0, stats);
}

Hit march_max_mip_bisect(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  return march<Refine::bisect>(target, ray, settings.bisect.halvings, stats);
}

bool occluded_max_mip(const HeightTarget& target, const Ray& ray) {
  return march<Refine::none>(target, ray, 0, nullptr).status == HitStatus::hit;
}

}  // namespace scarp
