// SPDX-License-Identifier: MIT
// Single-precision error bounds of a terrain function over a square of positions: for heights computed by shaders
// (march/function/function_heights.glsl.h), and for the width that remains in segment bounds as segments shrink
// (march/function/function_bounds.glsl.h).
//
// Each number of the program is tracked as the range of its true values and a bound of its error. Pairs of floats are
// accurate to kPair of an operation's operands, twice the bound of scarp_two_combine(); single floats, mainly in noise,
// add their own error (doc/dev/numerics.md, "Functions in single precision").
#pragma once

#include <algorithm>
#include <cmath>

#include "scarp/field/function_run.h"

namespace scarp::function {

inline constexpr double kFloat = 0x1p-24, kPair = 0x1p-43;
/// Maximum magnitude of numbers, far below float overflow.
inline constexpr double kMostSingle = 0x1p60;

/// Widening of range bounds: kScarpSlack of march/function/function_bounds.glsl.h.
inline constexpr double kRangeSlack = 0x1p-20;

struct Single {
  double low = 0, high = 0;  ///< range of the true values
  double error = 0;          ///< error bound of heights, and of bounds over segments that shrink to a point
  double range = 0;          ///< error bound of range results
  bool fits = true;          ///< whether the values fit in floats
  double root = -1;          ///< for squares: error of the squared value, otherwise negative
  double inverse = -1;       ///< for 1 + squares: error of the reciprocal, otherwise negative

  double most() const { return std::max(std::abs(low), std::abs(high)) + error; }
};

inline Single single_of(double low, double high, double error, double range, bool fits) {
  return {low, high, error, std::max(error, range),
          fits && low > -kMostSingle && high < kMostSingle && error < kMostSingle};
}
/// Result of an instruction that bounds evaluate by ranges, at least in part.
inline Single by_range(double low, double high, double error, double range, bool fits) {
  return single_of(low, high, std::max(error, range), range, fits);
}

inline void set_constant(Single& out, double k) {
  out = single_of(k, k, kPair * std::abs(k), kRangeSlack * std::abs(k), true);
}
inline Single combine(double k0, const Single& a, double k1, const Single& b, double k2) {
  const double ka = std::abs(k0), kb = std::abs(k1), size = ka * a.most() + kb * b.most() + std::abs(k2);
  const double p = k0 * a.low, q = k0 * a.high, r = k1 * b.low, s = k1 * b.high;
  Single out = single_of(std::min(p, q) + std::min(r, s) + k2, std::max(p, q) + std::max(r, s) + k2,
                         ka * a.error + kb * b.error + kPair * size, ka * a.range + kb * b.range + kRangeSlack * size,
                         a.fits && b.fits);
  // 1 / (1 + k x^2) changes by at most 3 sqrt(3) / 8 sqrt(k) per unit of x.
  if (a.root >= 0 && b.root >= 0 && k0 >= 0 && k1 >= 0 && k2 == 1)
    out.inverse = 0.65 * (std::sqrt(k0) * a.root + std::sqrt(k1) * b.root);
  return out;
}
inline Single turned_place(double k0, const Single& a, double k1, const Single& b) { return combine(k0, a, k1, b, 0); }
inline Single multiply(const Single& a, const Single& b) {
  const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
  const double size = a.most() * b.most();
  return single_of(std::min({p, q, r, s}), std::max({p, q, r, s}),
                   a.most() * b.error + b.most() * a.error + kPair * size,
                   a.most() * b.range + b.most() * a.range + kRangeSlack * size, a.fits && b.fits);
}
inline Single square(const Single& a) {
  Single s = multiply(a, a);
  s.low = std::max(0.0, s.low);
  s.root = a.error;
  return s;
}
inline Single absolute(const Single& a) {
  const double least = a.low <= 0 && a.high >= 0 ? 0 : std::min(std::abs(a.low), std::abs(a.high));
  return by_range(least, std::max(std::abs(a.low), std::abs(a.high)), a.error, a.range, a.fits);
}
inline Single clamp(const Single& a, double low, double high) {
  return by_range(clamp(a.low, low, high), clamp(a.high, low, high), a.error, a.range, a.fits);
}
inline Single sine(const Single& a) {
  return single_of(-1, 1, a.error + 4 * kFloat + kPair * a.most(), a.range + kRangeSlack, a.fits);
}
inline Single minimum(const Single& a, const Single& b) {
  return by_range(std::min(a.low, b.low), std::min(a.high, b.high), std::max(a.error, b.error),
                  a.range + b.range + kRangeSlack * (a.most() + b.most()), a.fits && b.fits);
}
inline Single maximum(const Single& a, const Single& b) {
  return by_range(std::max(a.low, b.low), std::max(a.high, b.high), std::max(a.error, b.error),
                  a.range + b.range + kRangeSlack * (a.most() + b.most()), a.fits && b.fits);
}
/// The weight of a is accurate to 4 units within the radius and exact beyond; its error matters least near 0 and 1.
inline Single smooth_minimum(const Single& a, const Single& b, double radius) {
  const double size = a.most() + b.most() + radius;
  return single_of(std::min(a.low, b.low) - 0.25 * radius, std::min(a.high, b.high),
                   std::max(a.error, b.error) + 2 * kRangeSlack * size,
                   std::max(a.range, b.range) + 2 * kRangeSlack * size, a.fits && b.fits);
}
/// The true a is at least 1; the computed one is 1 plus a non-negative value.
inline Single reciprocal(const Single& a) {
  const double error = a.inverse >= 0 ? a.inverse : 2 * a.error;
  return single_of(0, 1, std::min(1.0, error) + kRangeSlack, std::min(1.0, 2 * a.range) + kRangeSlack, a.fits);
}
/// `step` * (whole + fade): the fade of a phase accurate to 6 units over `rise`.
inline Single terrace(const Single& a, double step, double rise) {
  const double steepest = kSteepestFade / rise, slack = kRangeSlack * (a.most() + step) * (1 + steepest);
  return by_range(a.low - step, a.high + step, steepest * a.error + slack, steepest * a.range + slack, a.fits);
}
inline Single radial(const Single& x, const Single& y, const FunctionInstruction& in) {
  const double steepest = kSteepestFade / (in.k3 - in.k2);
  const double slack = kRangeSlack * (8 + steepest * (x.most() + y.most() + std::abs(in.k0) + std::abs(in.k1) + in.k3));
  return by_range(0, 1, steepest * (x.error + y.error) + slack, steepest * (x.range + y.range) + slack,
                  x.fits && y.fits);
}

/// Error of computed noise at an exact position: scarp_noise_bound() of march/function/noise.glsl.h.
inline double noise_off(NoiseKind kind) {
  return kind == NoiseKind::simplex ? 0x1p-15 : kind == NoiseKind::perlin ? 0x1p-17 : 0x1p-18;
}
inline double noise_slope_off(NoiseKind kind) {
  return kind == NoiseKind::simplex ? 0x1p-11 : kind == NoiseKind::perlin ? 0x1p-15 : 0x1p-17;
}

inline void noise_slope(const FunctionInstruction& in, const Single& a, const Single& b, Single& n, Single& x,
                        Single& y) {
  const NoiseBound bound = bound_of(in.kind);
  const double moved = a.error + b.error + kPair * (a.most() + b.most());
  const bool fits = a.fits && b.fits;
  const double off = std::min(2 * bound.height, bound.slope * moved) + noise_off(in.kind) + 2 * kRangeSlack;
  const double slope_off =
      std::min(2 * bound.slope, bound.curvature * moved) + noise_slope_off(in.kind) + 2 * kRangeSlack * bound.slope;
  n = single_of(-bound.height, bound.height, off, off, fits);
  x = y = single_of(-bound.slope, bound.slope, slope_off, slope_off, fits);
}
inline Single noise_value(const FunctionInstruction& in, const Single& a, const Single& b) {
  Single n, x, y;
  noise_slope(in, a, b, n, x, y);
  return n;
}

/// Heights at positions up to `reach` metres from the origin along each axis.
inline Single single_height(const FunctionProgram& program, double reach) {
  const Single place = single_of(-reach, reach, kPair * reach, kRangeSlack * reach, true);
  return run(program, place, place);
}

}  // namespace scarp::function
