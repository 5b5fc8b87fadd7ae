// SPDX-License-Identifier: MIT
// Distance functions of single solids, relative to their centre; k are the constants after the centre.
//
// Signed and exact except for the ellipsoid, a bound: the norm |q / radii| changes by at most 1 / (smallest radius) per
// metre. Sources: elementary geometry; J. C. Hart, "Sphere tracing", 1996, appendix A; the cone after I. Quilez,
// "Distance functions", 2008.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <limits>

#include "scarp/field/distance_program.h"

namespace scarp::distance {

template <class T>
using Vec = glm::vec<3, T>;

template <class T>
T length2(T x, T y) {
  using std::sqrt;
  return sqrt(x * x + y * y);
}
template <class T>
T length3(T x, T y, T z) {
  using std::sqrt;
  return sqrt(x * x + y * y + z * z);
}
template <class T>
T positive(T a) {
  return std::max(a, T(0));
}

/// Signed distance to the quadrant or octant in which all coordinates are negative.
template <class T>
T corner2(T x, T y) {
  return length2(positive(x), positive(y)) + std::min(std::max(x, y), T(0));
}
template <class T>
T corner3(T x, T y, T z) {
  return length3(positive(x), positive(y), positive(z)) + std::min(std::max({x, y, z}), T(0));
}

template <class T>
T sphere(const Vec<T>& q, const double* k) {
  return length3(q.x, q.y, q.z) - T(k[0]);
}
template <class T>
T box(const Vec<T>& q, const double* k) {
  return corner3(std::abs(q.x) - T(k[0]), std::abs(q.y) - T(k[1]), std::abs(q.z) - T(k[2])) - T(k[3]);
}
template <class T>
T plane(const Vec<T>& p, const double* k) {
  return T(k[0]) * p.x + T(k[1]) * p.y + T(k[2]) * p.z - T(k[3]);
}
template <class T>
T capsule(const Vec<T>& q, const double* k) {
  return length3(q.x, q.y, positive(std::abs(q.z) - T(k[0]))) - T(k[1]);
}
template <class T>
T cylinder(const Vec<T>& q, const double* k) {
  return corner2(length2(q.x, q.y) - T(k[0]), std::abs(q.z) - T(k[1]));
}
template <class T>
T cone(const Vec<T>& q, const double* k) {
  const T below = T(k[0]), above = T(k[1]), half = T(k[2]);
  const T r = length2(q.x, q.y), beyond = std::abs(q.z) - half;
  // Distances to the nearer disc and to the side; `along` is the fraction of the side's length from its upper end.
  const T disc = length2(positive(r - (q.z < 0 ? below : above)), beyond);
  const T dr = below - above, dz = -2 * half;
  const T along = std::clamp(((r - above) * dr + (q.z - half) * dz) / (dr * dr + dz * dz), T(0), T(1));
  const T side_r = r - (above + along * dr), side_z = q.z - (half + along * dz);
  const T distance = std::min(disc, length2(side_r, side_z));
  return side_r < 0 && beyond < 0 ? -distance : distance;
}
template <class T>
T torus(const Vec<T>& q, const double* k) {
  return length2(length2(q.x, q.y) - T(k[0]), q.z) - T(k[1]);
}
template <class T>
T ellipsoid(const Vec<T>& q, const double* k) {
  return (length3(q.x / T(k[0]), q.y / T(k[1]), q.z / T(k[2])) - 1) * T(k[3]);
}

/// Distance to a box, 0 inside; k: low, high.
template <class T>
T outside(const Vec<T>& p, const double* k) {
  return length3(positive(std::max(T(k[0]) - p.x, p.x - T(k[3]))), positive(std::max(T(k[1]) - p.y, p.y - T(k[4]))),
                 positive(std::max(T(k[2]) - p.z, p.z - T(k[5]))));
}

/// Weight of a in the smooth minimum, which is lower than both by at most radius / 4.
template <class T>
T smooth_share(T a, T b, T radius) {
  return std::clamp(T(0.5) + T(0.5) * (b - a) / radius, T(0), T(1));
}
template <class T>
T smooth_minimum(T a, T b, T radius) {
  const T t = smooth_share(a, b, radius);
  return b + t * (a - b) - radius * t * (1 - t);
}

/// Index of the nearest copy along an axis, and the offset from its centre; k: the 12 numbers of copies.
template <class T>
struct Copy {
  T number, off;
};
template <class T>
Copy<T> nearest_copy(T p, const double* k, int axis) {
  const T period = T(k[3 + axis]), count = T(k[6 + axis]), away = p - T(k[axis]);
  if (period == 0) return {0, away};
  T number = std::round(away / period);
  if (count > 0) number = std::clamp(number, -count, count);
  return {number, away - number * period};
}
/// Whether the nearest copy has a neighbour on the position's side.
template <class T>
bool has_neighbour(const Copy<T>& copy, const double* k, int axis) {
  const T count = T(k[6 + axis]);
  return count == 0 || (T(0) > copy.off ? copy.number > -count : count > copy.number);
}

template <class T>
Vec<T> folded(const Vec<T>& p, const double* k) {
  Vec<T> q;
  for (int axis = 0; axis < 3; ++axis) q[axis] = p[axis] - nearest_copy(p[axis], k, axis).number * T(k[3 + axis]);
  return q;
}
template <class T>
Vec<T> folded_next(const Vec<T>& p, const double* k, int mask) {
  Vec<T> q;
  for (int axis = 0; axis < 3; ++axis) {
    const Copy<T> copy = nearest_copy(p[axis], k, axis);
    const T number = copy.number + (mask >> axis & 1 ? (T(0) > copy.off ? T(-1) : T(1)) : T(0));
    q[axis] = p[axis] - number * T(k[3 + axis]);
  }
  return q;
}
/// Lower bound of the distance to the adjacent copy along the axes of `mask`; infinite if there is none.
template <class T>
T neighbour_bound(const Vec<T>& p, const double* k, int mask) {
  T sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Copy<T> copy = nearest_copy(p[axis], k, axis);
    T away = std::abs(copy.off);
    if (mask >> axis & 1) {
      if (!has_neighbour(copy, k, axis)) return std::numeric_limits<T>::infinity();
      away = T(k[3 + axis]) - away;
    }
    away = positive(away - T(k[9 + axis]));
    sum += away * away;
  }
  return std::sqrt(sum);
}
/// Lower bound of the squared distance to all copies along an axis except the nearest and its neighbour.
template <class T>
T rest_bound_along(const Vec<T>& p, const double* k, int axis) {
  T sum = 0;
  for (int i = 0; i < 3; ++i) {
    T away = std::abs(nearest_copy(p[i], k, i).off);
    if (i == axis) away += T(k[3 + i]);
    away = positive(away - T(k[9 + i]));
    sum += away * away;
  }
  return sum;
}
template <class T>
T rest_bound(const Vec<T>& p, const double* k) {
  T least = std::numeric_limits<T>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (k[3 + axis] != 0) least = std::min(least, rest_bound_along(p, k, axis));
  }
  return std::sqrt(least);
}

}  // namespace scarp::distance
