// SPDX-License-Identifier: MIT
// Curvature bounds of the distances of single solids.
#include <algorithm>
#include <array>
#include <cmath>

#include "scarp/field/distance_local.h"

namespace scarp::distance {
namespace {

double sign_of(double x) { return x < 0 ? -1 : 1; }

// Bounds, in a ball of radius r, the curvature of the distance to a point, line or core at distance `away`: the
// curvature is at most 1 / distance.
double bend_of(double away, double r) { return away > r ? 1 / (away - r) : kCreased; }

// Direction away from the z axis; arbitrary on the axis.
dvec3 from_axis(const dvec3& q, double distance) {
  return distance > 0 ? dvec3(q.x / distance, q.y / distance, 0) : dvec3(1, 0, 0);
}

// The corner in which all `a` are negative; a[i] grows by 1 per metre along axis[i]. bend[i] is the curvature of a[i]
// itself.
template <std::size_t N>
Bent corner(const std::array<double, N>& a, const std::array<dvec3, N>& axis, const std::array<double, N>& bend,
            double r) {
  std::size_t top = 0;
  for (std::size_t i = 1; i < N; ++i) {
    if (a[i] > a[top]) top = i;
  }
  // A single face is the nearest in the whole ball: the other planes are behind it.
  bool alone = true;
  for (std::size_t i = 0; i < N; ++i) alone = alone && (i == top || (a[i] + r <= 0 && a[i] + r <= a[top] - r));
  if (alone) return {a[top], axis[top], bend[top]};
  double square = 0;
  dvec3 out(0.0);
  for (std::size_t i = 0; i < N; ++i) {
    if (a[i] <= 0) continue;
    square += a[i] * a[i];
    out += a[i] * axis[i];
  }
  const double away = std::sqrt(square);
  if (!(away > 0)) return {a[top], axis[top], r == 0 ? bend[top] : kCreased};
  return {away, out / away, bend_of(away, r)};
}

Bent bent_cone(const dvec3& q, const double* k, double r) {
  const double below = k[0], above = k[1], half = k[2], from_z = length2(q.x, q.y);
  const dvec3 outwards = from_axis(q, from_z);
  const double dr = below - above, side = std::hypot(dr, 2 * half);
  // The side's normal is (2 half, dr) / side in the half plane of (radius, z); the side runs along (dr, -2 half).
  const double normal_r = 2 * half / side, normal_z = dr / side;
  const double off = (from_z - above) * normal_r + (q.z - half) * normal_z;
  const double along = (from_z - above) * normal_z - (q.z - half) * normal_r;  // 0 at the top to `side` at the bottom
  const double beyond = std::abs(q.z) - half;
  const double value = cone(q, k);
  const dvec3 side_normal = outwards * normal_r + dvec3(0, 0, normal_z);
  const dvec3 disc_normal(0, 0, sign_of(q.z));
  // A single face is the nearest in the whole ball.
  if (along - r >= 0 && along + r <= side && beyond + r <= off - r && (off - r >= 0 || beyond + r <= 0)) {
    return {value, side_normal, r > 0 ? bend_of(from_z, r) : 0};
  }
  const double rim = q.z < 0 ? below : above;
  if (from_z + r <= rim && std::abs(q.z) > r && off + r <= beyond - r) return {value, disc_normal, 0};
  if (value > 0) {
    // To the nearest point, on a rim or a face.
    const double clamped = std::clamp(along, 0.0, side);
    const double side_r = from_z - (above + clamped * normal_z), side_z = q.z - (half - clamped * normal_r);
    const double disc_r = positive(from_z - rim);
    dvec3 away = outwards * side_r + dvec3(0, 0, side_z);
    if (beyond > 0 && length2(disc_r, beyond) < length(away))
      away = outwards * disc_r + dvec3(0, 0, q.z - sign_of(q.z) * half);
    const double distance = length(away);
    return {value, distance > 0 ? away / distance : side_normal, bend_of(value, r)};
  }
  return {value, off >= beyond ? side_normal : disc_normal, kCreased};
}

Bent bent_torus(const dvec3& q, const double* k, double r) {
  const double from_z = length2(q.x, q.y), off = from_z - k[0], away = length2(off, q.z);
  const dvec3 outwards = from_axis(q, from_z);
  const dvec3 gradient = away > 0 ? (outwards * off + dvec3(0, 0, q.z)) / away : dvec3(0.0);
  return {away - k[1], gradient, std::max(bend_of(away, r), bend_of(from_z, r))};
}

}  // namespace

Bent bent_solid(DistanceOp op, const dvec3& q, const double* k, double r) {
  switch (op) {
    case DistanceOp::sphere: {
      const double away = length(q);
      return {sphere(q, k), away > 0 ? q / away : dvec3(0.0), bend_of(away, r)};
    }
    case DistanceOp::box: {
      std::array<double, 3> a, bend;
      std::array<dvec3, 3> axis{dvec3{sign_of(q.x), 0, 0}, dvec3{0, sign_of(q.y), 0}, dvec3{0, 0, sign_of(q.z)}};
      for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(i);
        a[at] = std::abs(q[i]) - k[i];
        bend[at] = std::abs(q[i]) > r ? 0 : kCreased;
      }
      Bent bent = corner(a, axis, bend, r);
      bent.value -= k[3];
      return bent;
    }
    case DistanceOp::capsule: {
      const double z = sign_of(q.z) * positive(std::abs(q.z) - k[0]);
      const double away = length3(q.x, q.y, z);
      return {away - k[1], away > 0 ? dvec3(q.x, q.y, z) / away : dvec3(0.0), bend_of(away, r)};
    }
    case DistanceOp::cylinder: {
      const double from_z = length2(q.x, q.y);
      return corner<2>({from_z - k[0], std::abs(q.z) - k[1]}, {from_axis(q, from_z), dvec3(0, 0, sign_of(q.z))},
                       {bend_of(from_z, r), std::abs(q.z) > r ? 0 : kCreased}, r);
    }
    case DistanceOp::cone:
      return bent_cone(q, k, r);
    case DistanceOp::torus:
      return bent_torus(q, k, r);
    case DistanceOp::ellipsoid: {
      // The norm's second derivative is at most 1 / (smallest radius)^2 over the norm.
      const dvec3 scaled(q.x / k[0], q.y / k[1], q.z / k[2]);
      const double norm = length(scaled);
      const dvec3 gradient(scaled.x / k[0], scaled.y / k[1], scaled.z / k[2]);
      return {(norm - 1) * k[3], norm > 0 ? gradient * (k[3] / norm) : dvec3(0.0), bend_of(norm * k[3], r)};
    }
    default:
      return {0, dvec3(0.0), kCreased};
  }
}

Bent bent_outside(const dvec3& p, const double* k, double r) {
  std::array<double, 3> a, bend{};
  std::array<dvec3, 3> axis{};
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double below = k[i] - p[i], above = p[i] - k[3 + i];
    a[at] = std::max(below, above);
    axis[at] = dvec3(0.0);
    axis[at][i] = below > above ? -1 : 1;
    bend[at] = std::abs(below - above) > 2 * r ? 0 : kCreased;
  }
  return corner(a, axis, bend, r);
}

}  // namespace scarp::distance
