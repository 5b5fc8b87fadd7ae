// SPDX-License-Identifier: MIT
// How far the answers of a scanner may be off its geometry: what rounds is derived here, once.
#pragma once

#include <cmath>
#include <glm/common.hpp>

#include "scarp/base/vec.h"

namespace scarp::test {

/// Radians by which a direction of length 1 is turned: its three components are floats, off by 2^-25 each.
constexpr double kTurnOfDirection = 0x1p-23;
/// The share of a range by which fans may be off (doc/dev/numerics.md, "The tolerance"); batches are nearer.
constexpr double kOfTheWay = 0x1p-20;

/// Metres from a hit on a plain, along the ray or beside it. A ray that is turned meets the plane farther on, by the
/// turn times range / tan(elevation).
inline double room_on_plain(double range, double elevation) {
  return range * (kOfTheWay + kTurnOfDirection * (1 + 1 / std::tan(std::abs(elevation))));
}
/// Radians of an angle that is a float, off by half a unit of 4 to 8, of a ray with this elevation. Elevations
/// themselves: 0.
inline double room_of_angle(double elevation = 0) { return kTurnOfDirection / std::cos(elevation) + 0x1p-22; }

/// Metres by which a hit at this range may be above or below the ground: the share of a clearance by which fans may be
/// off (as above) times what it is a share of. `edge` is the greatest difference of height along an edge of a cell,
/// holes as the lowest sample, `cell` the shorter side of a cell.
inline double room_above(double range, double edge, double cell) {
  return 0x1p-18 * (range + (range / cell + 12) * edge);
}

/// Whether two answers to a ray are one hit: at one place of the way, or along the ground from one to the other.
/// `height(x, y)` is the ground's, if there is any.
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
