// SPDX-License-Identifier: MIT
// Judges answers of marches in single precision: the possible hits of a ray if every clearance is known only to a
// bound.
//
// The true clearance along the ray is followed in double, from one extreme to the next. With delta, the bound that
// doc/dev/numerics.md derives ("Single precision"), a march may treat a ray as above or below the ground wherever the
// clearance is within 2 delta (delta for the value, delta for the compared value), and nowhere else; and it may see or
// miss a hole, a rim or a border only where the ray passes within the sideways bound of it. The judge therefore keeps
// the SET of possible beliefs of a march. An answer is wrong if no belief leads to it.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "scarp/field/height_field.h"

namespace scarp::test {

class RoundingJudge {
 public:
  /// `ray` is valid. `tile` is the number of cells after which a march starts a new frame; at most 1,024. `world_unit`
  /// is the unit roundoff of the code that clipped the ray to the field.
  RoundingJudge(const HeightField& field, const Ray& ray, double tile = 1024, double world_unit = 0x1p-53);

  /// Empty if this is a valid answer of a march, otherwise the reason.
  std::string objection(const Hit& hit) const;
  /// Whether a march may report no hit up to t.
  bool may_pass(double t) const { return !meets_field_ || follow(t * scale_).any(); }
  bool may_miss() const { return may_pass(HUGE_VAL); }
  /// Lower and upper bound of the ray's height in metres above the surface at t as a march may compute it; unbounded
  /// over holes, outside, or where that is not certain.
  struct Bounds {
    double low = -HUGE_VAL, high = HUGE_VAL;
  };
  Bounds clearance_at(double t) const;

 private:
  struct Place {
    int col, row;  // cell, over all copies
    double u, v;
  };
  struct Event {
    double t;
    int col, row;
    enum What { ground, hole } what;
    double clearance, delta;
    bool enters;        // starts a piece of a cell
    bool touches_hole;  // a hole or border is within sideways rounding
    bool along_ground;  // a hole, but the ray runs along its rim
    bool may_leave;     // the ray may be treated as having left the field here
    bool brief;         // a piece no longer than sideways rounding
  };
  struct Beliefs {
    bool unknown = false, above = false, below = false, gone = false;
    bool any() const { return unknown || above || below || gone; }
  };

  double at(int axis, double t) const { return origin_[axis] + direction_[axis] * t; }
  bool exists(int col, int row) const;
  bool is_ground(int col, int row) const;
  Cell within(int col, int row) const;
  CellHeights heights(int col, int row) const;
  double relief(int col, int row) const;
  double clearance(int col, int row, double t) const;
  bool comes_below(double t, double off) const;
  double sideways(double t) const;
  double delta(int col, int row, double t) const;
  void add_piece(double begin, double end);
  void add_event(int col, int row, double t, bool enters, double begin, double end);
  bool near(int col, int row, double begin, double end, bool border_only) const;
  bool runs_along_ground(int col, int row, double begin, double end) const;
  Beliefs follow(double until) const;

  const HeightField& field_;
  const Ray& ray_;
  dvec3 origin_, direction_;
  double begin_ = 0, end_ = 0, scale_ = 1, tile_, world_unit_;
  bool strict_, from_outside_ = false, may_be_from_outside_ = false, meets_field_ = false;
  double start_relief_ = 0;
  std::vector<Event> events_;
};

}  // namespace scarp::test
