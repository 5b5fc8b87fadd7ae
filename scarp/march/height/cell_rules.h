// SPDX-License-Identifier: MIT
// The rules of one cell of `max-mip`: which crossing of its surface is a hit, and where.
//
//   entry: side known ──▶ clearance at the exit ──▶ signs differ: a hit, at the root of the clearance along the ray
//          unknown: from the clearance there        both above: a hit if the clearance dips to zero in between
//
// Signs decide, at lines that neighbours share; the root only locates the hit. Functions return true if the query is
// answered.
#pragma once

#include <algorithm>
#include <cassert>
#include <utility>

#include "scarp/march/height/walk_ray.h"

namespace scarp::max_mip {
namespace {

template <class T, bool Holes, bool Wraps, Ask ask>
class CellRules : public WalkRay<T, Holes, Wraps, ask> {
 public:
  using Base = WalkRay<T, Holes, Wraps, ask>;

  CellRules(const HeightTarget& target, const SampleGrid<T>& grid, const Ray& ray, const GridRay& local,
            const Wanted& wanted, Hit& answer)
      : Base(target, grid, ray, local, wanted), answer_(answer) {}

 protected:
  using Base::from_outside_, Base::begun_, Base::slow_, Base::below_rim_;
  using Base::grid_ray, Base::ground_, Base::x_, Base::y_, Base::t_in_, Base::strict_, Base::triangles_;
  using Base::lists, Base::bisects, Base::accepts, Base::lost, Base::rounding_of_clearance, Base::is_hit;
  using Base::solid_, Base::wanted_, Base::ray_, Base::col_, Base::row_, Base::side_, Base::through_, Base::cell_end_;
  using Base::stats, Base::ray_height, Base::quadratic, Base::plane, Base::south_east, Base::clearance, Base::rim;

  // Tests the surface of the current cell, up to the line that ends it, or the border before that. Returns true if the
  // answer is known; otherwise side_ is that of the exit.
  [[gnu::always_inline]] bool test_cell(const CellHeights& h, bool through_x, double t_line, double t_out) {
    ++stats.cell_tests;
    cell_end_ = t_out;
    if (strict_) {
      // The ray is in the given start cell; by rounding, surrounding lines may be crossed before it starts, since its
      // position is clamped and its height must not run ahead.
      t_in_ = std::max(t_in_, ray_.t_min);
      t_out = std::max(t_out, ray_.t_min);
    }
    if (side_ == Side::unknown && find_side(h)) return true;
    const Through exit = t_line > t_out ? Through::point : through_x ? Through::x_line : Through::y_line;
    const double out = clearance(h, exit, true, t_out);
    return triangles_ ? test_triangles(h, out, t_out) : test_bilinear(h, out, t_out);
  }

  // Determines the side of the ray; returns true if that is the answer. There is no previous crossing to agree with. A
  // ray that crosses a rim within rounding of it touches it, for either sign: otherwise a ray through the corner of a
  // hole, above on one side, could be below on the other.
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
      // All hits: after this one the ray counts as above only if it is by more than rounding, like any ray from below.
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

  // The bilinear cell in which a ray starts on the surface: f(s) = s (a s + b) is negative right after the start, or
  // after the second root, if anywhere by more than rounding. Returns true if the answer is known.
  bool falls_from_start(const CellQuadratic& f, double length) {
    const bool dips = f.a > 0 && f.b < 0 && -f.b < 2 * f.a * length;
    const double last = length * (f.a * length + f.b), lowest = dips ? -f.b * f.b / (4 * f.a) : last;
    if (!(lowest < 0 && is_hit(lowest, t_in_))) return false;
    if (answer(f.b < 0 || f.a == 0 ? 0.0 : f.b / -f.a)) return true;
    if (last <= rounding_of_clearance(t_in_ + length)) side_ = Side::below;
    return false;
  }

  // The signs imply a hit in the cell; the quadratic only locates it.
  [[gnu::always_inline]] bool hit_in_cell(const CellQuadratic& f, double length) {
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
  // `place`: its position in the cell, if not that of the ray.
  bool answer(double s, bool wall = false, const dvec2* place = nullptr) {
    const double t = std::max(s > 0 ? std::min(t_in_ + s, cell_end_) : t_in_ + s, ray_.t_min);
    // From the surface, the ray is below it only after t.
    if (strict_ ? t >= ray_.t_max : t > ray_.t_max) return !lists();
    const HitStatus before = std::exchange(answer_.status, HitStatus::hit);
    if constexpr (ask == Ask::any) return true;
    answer_.t = t;
    answer_.cell = {col_, row_};
    // Callers may claim that a ray starts on a surface that is elsewhere.
    assert(bisects() || strict_ || rim(grid_ray()).is_height_of_ground(t, wall));
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

  Hit& answer_;
};

}  // namespace
}  // namespace scarp::max_mip
