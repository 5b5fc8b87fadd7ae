// SPDX-License-Identifier: MIT
// Closest points of triangles and segments. Source: C. Ericson, Real-Time Collision Detection (2005), 5.1.5 and 5.1.9.
#pragma once

#include <algorithm>
#include <array>

#include "scarp/base/vec.h"

namespace scarp {

/// Returns the point of a triangle closest to p, by the Voronoi region of the triangle that contains p.
inline dvec3 closest_of_triangle(const dvec3& p, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  const dvec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const dvec3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const dvec3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  const double sum = va + vb + vc;
  return a + vb / sum * ab + vc / sum * ac;
}

/// Two points, one on each shape.
struct ClosestPair {
  dvec3 first{0.0}, second{0.0};
  double square() const { return dot(first - second, first - second); }
};

/// Returns the closest points of the segments p + s d and q + t e, with s and t from 0 to 1. Either segment may be a
/// point.
inline ClosestPair closest_of_segments(const dvec3& p, const dvec3& d, const dvec3& q, const dvec3& e) {
  const dvec3 r = p - q, n = cross(d, e);
  const double dd = dot(d, d), ee = dot(e, e), de = dot(d, e), dr = dot(d, r), er = dot(e, r);
  // Uses the cross product: the difference dd ee - de de loses all digits for nearly parallel segments.
  const double square = dot(n, n);
  double s = square > 0 ? std::clamp(dot(cross(e, r), n) / square, 0.0, 1.0) : 0.0;
  double t = ee > 0 ? (de * s + er) / ee : 0.0;
  if (!(t >= 0 && t <= 1) || !(square > 0)) {
    t = std::clamp(t, 0.0, 1.0);
    s = dd > 0 ? std::clamp((de * t - dr) / dd, 0.0, 1.0) : 0.0;
    if (ee > 0) t = std::clamp((de * s + er) / ee, 0.0, 1.0);
  }
  return {p + s * d, q + t * e};
}

/// Returns the closest points of a segment, p + s d, and a triangle; both are the same point if they intersect.
inline ClosestPair closest_of_segment_and_triangle(const dvec3& p, const dvec3& d, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  const dvec3 n = cross(b - a, c - a);
  const double from = dot(n, p - a), to = dot(n, p + d - a);
  if ((from > 0) != (to > 0) && from != to) {
    const dvec3 x = p + from / (from - to) * d;
    if (dot(n, cross(b - a, x - a)) >= 0 && dot(n, cross(c - b, x - b)) >= 0 && dot(n, cross(a - c, x - c)) >= 0)
      return {x, x};
  }
  ClosestPair best{p, closest_of_triangle(p, triangle)};
  const auto take = [&](const ClosestPair& pair) {
    if (pair.square() < best.square()) best = pair;
  };
  if (d != dvec3(0.0)) take({p + d, closest_of_triangle(p + d, triangle)});
  for (int i = 0; i < 3; ++i) {
    const dvec3& q = triangle[static_cast<std::size_t>(i)];
    take(closest_of_segments(p, d, q, triangle[static_cast<std::size_t>((i + 1) % 3)] - q));
  }
  return best;
}

}  // namespace scarp
