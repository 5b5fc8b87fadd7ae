// SPDX-License-Identifier: MIT
// How far the answers of a scanner may be off its geometry: the only derivation of these rounding errors.
#pragma once

#include <cmath>
#include <glm/common.hpp>

#include "scarp/base/vec.h"

namespace scarp::test {

/// Radians by which a direction of length 1 is rotated: its three components are floats, each off by up to 2^-25.
constexpr double kTurnOfDirection = 0x1p-23;
/// The fraction of a range by which fans may be off (doc/dev/numerics.md, "The tolerance"); batches are more accurate.
constexpr double kOfTheWay = 0x1p-20;

/// Error of a hit on a plain, in metres, along the ray or across it. A rotated ray meets the plane farther away, by the
/// rotation times range / tan(elevation).
inline double room_on_plain(double range, double elevation) {
  return range * (kOfTheWay + kTurnOfDirection * (1 + 1 / std::tan(std::abs(elevation))));
}
/// Error of an angle, in radians, for a ray with this elevation: angles are floats, off by half a unit in the last
/// place of numbers from 4 to 8. For elevations themselves, pass 0.
inline double room_of_angle(double elevation = 0) { return kTurnOfDirection / std::cos(elevation) + 0x1p-22; }

/// Metres by which a hit at this range may be above or below the ground: the relative error of a clearance in fans (as
/// above) times the quantity that it is relative to. `edge` is the greatest height difference along an edge of a
/// cell, with holes as the lowest sample; `cell` is the shorter side of a cell.
inline double room_above(double range, double edge, double cell) {
  return 0x1p-18 * (range + (range / cell + 12) * edge);
}

/// Whether two answers to a ray are the same hit: at the same position along the ray, or with the ray along the ground
/// between them. `height(x, y)` is the height of the ground, if there is any.
template <class Height>
bool is_one_hit(const dvec3& a, const dvec3& b, double range, double room, const Height& height) {
  if (length(b - a) <= 2 * kOfTheWay * range) return true;
  for (int i = 0; i <= 8; ++i) {
    const dvec3 p = mix(a, b, i / 8.0);
    const auto z = height(p.x, p.y);
    if (!z || !(std::abs(p.z - *z) <= (i % 8 == 0 ? 1 : 2) * room)) return false;
  }
  return true;
}

}  // namespace scarp::test
