// SPDX-License-Identifier: MIT
// Signed distance fields of solids: negative inside, positive outside. The magnitude never exceeds the distance to the
// surface.
//
//   tree of settings (distance_node.h) --compile--> flat program (distance_program.h)
//   program at a position  ---------> value, material (distance_run.h)
//   program over a segment of a ray -> linear model with a remainder (distance_local.h): bounds, and gradients
//
// value() is 1-Lipschitz: a ball of radius |value()| around a position contains no surface. It is the exact distance
// for single solids and outside unions of them. It is a lower bound inside unions, near edges of intersections, and for
// ellipsoids and grounds. Bounds hold for the true function; value() differs from it by at most rounding(). Outside
// box(), value() is at least the distance to the box.
#pragma once

#include "scarp/field/distance_node.h"
#include "scarp/field/distance_program.h"

namespace scarp {

/// Maximum absolute coordinate along each axis, in metres.
inline constexpr double kDistanceReach = 0x1p30;

/// Bounds of the field along a segment of a line, t = middle + s * half with s in [-1, 1]: the true value is within
/// `rest` of mid + slope * s, and between low and high, and so is value() at rounded positions. Its derivative by s is
/// between rate_low and rate_high.
struct DistanceSegment {
  double mid, slope, rest;
  double low, high;
  double rate_low, rate_high;
};

/// A compiled shape: signed distance bounds, gradients and materials.
class DistanceField {
 public:
  /// Throws Error if the shape is null or too large to compile.
  explicit DistanceField(Shape shape);

  const Shape& shape() const { return shape_; }
  const DistanceProgram& program() const { return program_; }
  /// Bounding box of the solid; infinite on sides where the solid is unbounded.
  const ShapeBox& box() const { return shape_->box; }

  /// Returns the field at a position within kDistanceReach: a signed lower bound of the distance to the surface, in
  /// metres.
  double value(const dvec3& position) const;
  /// Returns a bound of the rounding error of value(), in metres, for positions up to `reach` metres from the origin.
  double rounding(double reach) const;
  /// Returns the material of the solid whose surface is nearest according to value(); 0 if that solid has no material.
  int material(const dvec3& position) const;

  /// Returns the analytic gradient of value(). At a crease it is the gradient of one side. Where it is undefined (at
  /// the centre of a sphere), returns finite differences over the corners of a tetrahedron.
  dvec3 gradient(const dvec3& position) const;
  /// Returns the outward unit normal: the direction of the gradient.
  dvec3 normal(const dvec3& position) const;

  /// Returns bounds along origin + t * direction for t in [t0, t1], within kDistanceReach. If `rates` is
  /// false, rate_low and rate_high are wide bounds: over grounds, tight rates cost as much as all other bounds
  /// together.
  DistanceSegment along(const dvec3& origin, const dvec3& direction, double t0, double t1, bool rates = true) const;

 private:
  Shape shape_;
  DistanceProgram program_;
};

}  // namespace scarp
