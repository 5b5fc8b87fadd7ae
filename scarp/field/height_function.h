// SPDX-License-Identifier: MIT
// Procedural terrain: a height function over the whole plane, its gradients, and certified bounds of both.
//
//   tree of settings (function_node.h) --compile--> flat programs (function_program.h), one per use
//   program over doubles ---------------------------> heights; with derivatives: analytic gradients
//   program over Taylor models (function_taylor.h) -> bounds over rectangles, and along segments of a ray
//
// Bounds hold for the true function; value() differs from it by at most `rounding`. Noise, and functions built from it
// without Sines, are bit-identical on all machines. Bounds always hold but are not the tightest possible.
#pragma once

#include "scarp/field/function_node.h"
#include "scarp/field/function_program.h"

namespace scarp {

/// Maximum absolute x and y, in metres. Beyond it, doubles are at least 2^-22 m apart.
inline constexpr double kFunctionReach = 0x1p30;

/// A rectangle of the plane, metres; low <= high.
struct FunctionRectangle {
  double x_low, x_high, y_low, y_high;
};

/// Bounds of a function over a rectangle.
struct FunctionBound {
  double low, high;  ///< of the true heights, metres
  double slope;      ///< maximum length of the true gradient, metres per metre
  double rounding;   ///< maximum error of computed heights, metres
};

/// Bounds of a function along a segment of a line, t = middle + s * half with s in [-1, 1]: the true height is within
/// `rest` of mid + slope * s, and between low and high.
struct SegmentBound {
  double mid, slope, rest;
  double low, high;
  double rounding;  ///< maximum error of heights computed at rounded positions
};

/// A compiled terrain function: heights, gradients and certified bounds.
class HeightFunction {
 public:
  /// Throws Error if the function is null or too large to compile.
  explicit HeightFunction(Function function);

  const Function& function() const { return function_; }
  const FunctionProgram& program(FunctionUse use) const { return programs_[static_cast<int>(use)]; }

  /// Returns the height in metres at a position within kFunctionReach.
  double value(double x, double y, FunctionUse use = FunctionUse::march) const;
  /// Returns the gradient (dh/dx, dh/dy), in metres per metre. At a crease (absolute, minimum, ...) it is the gradient
  /// of one side.
  dvec2 gradient(double x, double y, FunctionUse use = FunctionUse::normal) const;

  /// Returns bounds over a rectangle within kFunctionReach.
  FunctionBound bound(const FunctionRectangle& rectangle, FunctionUse use = FunctionUse::march) const;
  /// Returns bounds over the whole plane.
  const FunctionBound& bound_everywhere(FunctionUse use = FunctionUse::march) const {
    return everywhere_[static_cast<int>(use)];
  }

  /// Returns bounds along origin + t * direction for t in [t0, t1], within kFunctionReach.
  SegmentBound along(dvec2 origin, dvec2 direction, double t0, double t1, FunctionUse use = FunctionUse::march) const;
  /// Returns a lower and an upper bound of dh/dt along the same segment.
  dvec2 slope_along(dvec2 origin, dvec2 direction, double t0, double t1, FunctionUse use = FunctionUse::march) const;

  /// Whether normals are those of the marched surface: FunctionUse::normal and FunctionUse::march have the same
  /// program.
  bool normals_are_of_march() const { return normals_are_of_march_; }

 private:
  Function function_;
  FunctionProgram programs_[3];
  bool normals_are_of_march_ = false;
  FunctionBound everywhere_[3];
};

}  // namespace scarp
