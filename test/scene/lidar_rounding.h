// SPDX-License-Identifier: MIT
// How far the answers of a scanner may be off its geometry: what rounds is derived here, once.
#pragma once

#include <cmath>

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

}  // namespace scarp::test
