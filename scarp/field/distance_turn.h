// SPDX-License-Identifier: MIT
// Rotations as rows of a matrix.
#pragma once

#include <array>
#include <cmath>

#include "scarp/base/vec.h"

namespace scarp {

using Turn = std::array<dvec3, 3>;

inline constexpr Turn kNoTurn{dvec3{1, 0, 0}, dvec3{0, 1, 0}, dvec3{0, 0, 1}};

inline dvec3 turned(const Turn& m, const dvec3& p) { return {dot(m[0], p), dot(m[1], p), dot(m[2], p)}; }
/// Inverse rotation: the transpose.
inline Turn back(const Turn& m) {
  return {dvec3{m[0].x, m[1].x, m[2].x}, dvec3{m[0].y, m[1].y, m[2].y}, dvec3{m[0].z, m[1].z, m[2].z}};
}
/// Composition: b first, then a.
inline Turn after(const Turn& a, const Turn& b) {
  const Turn columns = back(b);
  Turn m;
  for (std::size_t row = 0; row < 3; ++row) {
    m[row] = {dot(a[row], columns[0]), dot(a[row], columns[1]), dot(a[row], columns[2])};
  }
  return m;
}
/// Counter-clockwise rotation, seen from the tip of the axis (Rodrigues' formula). Quarter turns about the axes are
/// exact.
inline Turn turn_about(const dvec3& axis, double angle) {
  const dvec3 n = normalize(axis);
  // cos(pi / 2) is 6e-17 in double: values below 2^-50 are taken to be exact quarter turns.
  const auto snapped = [](double x) {
    return std::abs(x) < 0x1p-50 ? 0.0 : std::abs(x) > 1 - 0x1p-50 ? std::copysign(1.0, x) : x;
  };
  const double c = snapped(std::cos(angle)), s = snapped(std::sin(angle));
  return {dvec3{c + n.x * n.x * (1 - c), n.x * n.y * (1 - c) - n.z * s, n.x * n.z * (1 - c) + n.y * s},
          dvec3{n.y * n.x * (1 - c) + n.z * s, c + n.y * n.y * (1 - c), n.y * n.z * (1 - c) - n.x * s},
          dvec3{n.z * n.x * (1 - c) - n.y * s, n.z * n.y * (1 - c) + n.x * s, c + n.z * n.z * (1 - c)}};
}

}  // namespace scarp
