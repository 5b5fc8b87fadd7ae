// SPDX-License-Identifier: MIT
// Solids by their distance: for every position a number that is negative inside, positive outside, and never larger
// than the distance to the surface.
//
//   tree of settings (distance_node.h) --compile--> flat program (distance_program.h)
//   program at a position  ---------> value, material (distance_run.h)
//   program over a segment of a ray -> value there by a line and a remainder (distance_local.h): bounds, and gradients
//
// value() changes by no more than one metre per metre (1-Lipschitz), so a ball of this radius is free of the surface.
// It is the distance itself for single solids and, outside, for their unions; a bound elsewhere: inside of unions,
// near edges of intersections, for ellipsoids and grounds. A bound holds for the true function; what value() computes
// is within rounding() of that. Outside of box(), value() is at least the distance to the box.
#pragma once

#include "scarp/field/distance_node.h"
#include "scarp/field/distance_program.h"

namespace scarp {

/// The world ends here, metres from the origin along each axis.
inline constexpr double kDistanceReach = 0x1p30;

/// What is known of the field along a segment of a line, t = middle + s * half with s from -1 to 1: the true value is
/// within `rest` of mid + slope * s, and between low and high, and so is what value() computes at rounded positions;
/// its derivative by s is between rate_low and rate_high.
struct DistanceSegment {
  double mid, slope, rest;
  double low, high;
  double rate_low, rate_high;
};

class DistanceField {
 public:
  /// Throws Error for a shape that is missing or too large to compile.
  explicit DistanceField(Shape shape);

  const Shape& shape() const { return shape_; }
  const DistanceProgram& program() const { return program_; }
  /// Around the solid: finite, or infinite on the sides where it has no end.
  const ShapeBox& box() const { return shape_->box; }

  /// Signed bound of the distance to the surface at a position within kDistanceReach, metres.
  double value(const dvec3& position) const;
  /// By how much value() may differ from the true one at positions at most `reach` from the origin.
  double rounding(double reach) const;
  /// Material of the solid whose surface is the nearest, as value() tells; 0 where none was given.
  int material(const dvec3& position) const;

  /// Derivatives of value(); where there is a crease, those of one of its sides. Analytic, but for the few places where
  /// that fails (a sphere's centre): there from differences at the corners of a tetrahedron.
  dvec3 gradient(const dvec3& position) const;
  /// Unit normal out of the solid: the gradient's direction.
  dvec3 normal(const dvec3& position) const;

  /// Bounds along origin + t * direction for t from t0 to t1, within kDistanceReach. Without `rates` those of the
  /// derivative are wide: they cost as much as the others where there is ground.
  DistanceSegment along(const dvec3& origin, const dvec3& direction, double t0, double t1, bool rates = true) const;

 private:
  Shape shape_;
  DistanceProgram program_;
};

}  // namespace scarp
