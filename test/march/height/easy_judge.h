// SPDX-License-Identifier: MIT
// Judges answers of max-mip-easy by the bound of doc/dev/numerics.md ("The easy text"): the clearance of the ray is
// followed in double, cell by cell. An answer is wrong if the ray has passed a point below the ground by more than
// delta, or hits where it is above it by more than delta.
#pragma once

#include <string>
#include <vector>

#include "scarp/field/height_field.h"

namespace scarp::test {

/// An answer in grid units.
struct EasyAnswer {
  bool hit, below;
  double t;
  Cell cell;
  double u, v;
};

class EasyJudge {
 public:
  /// A bilinear field without holes and wrap. `clipped`: the ray starts, in floats, where it enters the field.
  EasyJudge(const HeightField& field, const GridRay& ray, double t_max, bool clipped = false);

  /// Empty if this is a valid answer of a march, otherwise the reason.
  std::string objection(const EasyAnswer& answer) const;
  /// Whether a march may treat the ray as starting below the ground.
  bool may_begin_below() const;
  /// Greatest error of the judged answers, as a multiple of delta.
  double worst() const { return worst_; }

 private:
  // A part of the ray over one cell.
  struct Piece {
    double begin, end;
  };

  double at(int axis, double t) const { return ray_.origin[axis] + ray_.direction[axis] * t; }
  Cell cell_at(double t) const;
  double clearance(Cell cell, double t) const;
  double sideways(double t) const;
  double delta(double t) const;
  double deepest(const Piece& piece) const;
  double passes_by(double until) const;

  const HeightField& field_;
  GridRay ray_;
  int cells_[2];
  double t_max_;
  bool over_field_ = false;
  double t_in_ = 0, t_out_ = 0;  // over the field
  double origin_ = 0, height_ = 0;
  std::vector<double> lines_;
  mutable double worst_ = 0;
};

}  // namespace scarp::test
