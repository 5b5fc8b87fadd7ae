// SPDX-License-Identifier: MIT
// The rules of `max-mip` beside the ground: touches on lines and at nodes, rims of holes, and the border of the field
// (max_mip_rims.h). Functions return true if the query is answered.
#pragma once

#include <algorithm>
#include <utility>

#include "scarp/march/height/cell_rules.h"

namespace scarp::max_mip {
namespace {

template <class T, bool Holes, bool Wraps, Ask ask>
class RimRules : public CellRules<T, Holes, Wraps, ask> {
 protected:
  using Base = CellRules<T, Holes, Wraps, ask>;
  using Base::Base;
  using Base::rim, Base::lists, Base::accepts, Base::answer, Base::grid_ray, Base::field_, Base::seam_, Base::x_;
  using Base::side_, Base::through_, Base::begun_, Base::below_rim_;
  using Base::y_, Base::t_in_, Base::strict_, Base::wanted_, Base::ray_, Base::answer_, Base::col_, Base::row_;

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

  // Records a touch at t, at a given position in a cell, which need not be on the ray's path. In lists of all hits,
  // touches of neighbouring cells at the same position count as one. Returns true if the query is answered.
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

  // Follows the ray beside the ground, during a time in which it is over none; side_ is then its side at the end,
  // unless `stay` keeps it. Returns true if the query is answered.
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
  // Follows the border before the ray is over the field, or throughout if it never is. A ray from the surface does not
  // enter.
  bool follow_border_on_entry() {
    const bool goes_in = t_in_ <= std::min(x_.exit_time(), y_.exit_time());  // wherever the range ends
    return follow_border(rim(grid_ray()).first_time(), goes_in ? t_in_ : rim(grid_ray()).last_time(), goes_in);
  }
  void follow_border_on_exit() {
    if (strict_ || (!lists() && answer_) || (side_ == Side::unknown && !begun_)) return;
    follow_border(std::min(x_.exit_time(), y_.exit_time()), rim(grid_ray()).last_time(), false);
  }
};

}  // namespace
}  // namespace scarp::max_mip
