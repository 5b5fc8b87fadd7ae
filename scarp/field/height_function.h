// SPDX-License-Identifier: MIT
// A procedural terrain: a height for every position of the plane, its gradient, and certified bounds of both.
//
//   tree of settings (function_node.h) --compile--> flat programs (function_program.h), one per use
//   program over doubles ---------------------------> heights; with derivatives: analytic gradients
//   program over Taylor models (function_taylor.h) -> bounds over rectangles, and along segments of a ray
//
// A bound holds for the true function; what value() computes is within `rounding` of that. Noise, and all that is built
// of it without Sines, is bit-equal on every machine. Bounds are sound, not tight: test/field prints how tight.
#pragma once

#include "scarp/field/function_node.h"
#include "scarp/field/function_program.h"

namespace scarp {

/// The plane ends here, metres from the origin in x and y: from here on doubles are coarser than 2^-22 m.
inline constexpr double kFunctionReach = 0x1p30;

/// A rectangle of the plane, metres; low <= high.
struct FunctionRectangle {
  double x_low, x_high, y_low, y_high;
};

/// What is known of a function over a rectangle.
struct FunctionBound {
  double low, high;  ///< of the true heights, metres
  double slope;      ///< of the true gradient's length, metres per metre, at most
  double rounding;   ///< metres by which a height as computed may differ from the true one
};

/// What is known of a function along a segment of a line, t = middle + s * half with s from -1 to 1: the true height
/// is within `rest` of mid + slope * s, and between low and high.
struct SegmentBound {
  double mid, slope, rest;
  double low, high;
  double rounding;  ///< by which a height as computed at a rounded position may differ from the true one
};

class HeightFunction {
 public:
  /// Throws Error for a function that is missing or too large to compile.
  explicit HeightFunction(Function function);

  const Function& function() const { return function_; }
  const FunctionProgram& program(FunctionUse use) const { return programs_[static_cast<int>(use)]; }

  /// Height at a position within kFunctionReach, metres.
  double value(double x, double y, FunctionUse use = FunctionUse::march) const;
  /// Its derivatives, metres per metre. Where there is a crease (absolute, minimum, ...), those of one of its sides.
  dvec2 gradient(double x, double y, FunctionUse use = FunctionUse::normal) const;

  /// Bounds over a rectangle within kFunctionReach.
  FunctionBound bound(const FunctionRectangle& rectangle, FunctionUse use = FunctionUse::march) const;
  /// Bounds over the whole plane.
  const FunctionBound& bound_everywhere(FunctionUse use = FunctionUse::march) const {
    return everywhere_[static_cast<int>(use)];
  }

  /// Bounds along origin + t * direction for t from t0 to t1, within kFunctionReach.
  SegmentBound along(dvec2 origin, dvec2 direction, double t0, double t1, FunctionUse use = FunctionUse::march) const;
  /// The least and greatest dh/dt there.
  dvec2 slope_along(dvec2 origin, dvec2 direction, double t0, double t1, FunctionUse use = FunctionUse::march) const;

  /// Whether normals are those of the surface that is marched: of as many octaves.
  bool normals_are_of_march() const { return normals_are_of_march_; }

 private:
  Function function_;
  FunctionProgram programs_[3];
  bool normals_are_of_march_ = false;
  FunctionBound everywhere_[3];
};

}  // namespace scarp
