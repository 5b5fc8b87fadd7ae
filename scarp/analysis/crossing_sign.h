// SPDX-License-Identifier: MIT
// Exact sign of a sum of products of doubles: a filter in doubles first, exact arithmetic where it is undecided.
//
// Source: J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric predicates", 1997.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace scarp {

/// Bound of the rounding error of the double sum, relative to the sum of absolute products: 8 u (numerics.md).
inline constexpr double kSumRounding = 0x1p-50;

/// The terms of one comparison: ground g0 w0 + g1 w1 against ray e v0 + r v1. Weights are integers.
struct CrossingTerms {
  double g0, w0, g1, w1, e, v0, r, v1;
};

/// Returns the exact sign (-1, 0, 1) of g0 w0 + g1 w1 - e v0 - r v1. The products must not overflow.
int exact_sign(const CrossingTerms& terms);

/// Returns the sign of g0 w0 + g1 w1 - e v0 - r v1, exact: positive if the ground is above the ray.
inline int sign_of(const CrossingTerms& t) {
  const double a = t.g0 * t.w0, b = t.g1 * t.w1, c = t.e * t.v0, d = t.r * t.v1;
  const double sum = (a + b) - (c + d);
  const double bound = kSumRounding * ((std::abs(a) + std::abs(b)) + (std::abs(c) + std::abs(d)));
  if (sum > bound) return 1;
  if (sum < -bound) return -1;
  return exact_sign(t);
}

/// Returns the smallest double r with sign_of(terms with that r) <= 0: the least ray end that clears this crossing.
/// v1 > 0.
double least_clearing(CrossingTerms terms);

}  // namespace scarp
