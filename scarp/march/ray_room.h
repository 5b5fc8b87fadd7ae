// SPDX-License-Identifier: MIT
// Ray::room: a distance in metres in the 16 spare bits of a Ray, which are the upper bits of a double.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace scarp {

constexpr int kRoomShift = 48;

/// Returns the distance that Ray::room encodes; exact.
inline double room_in_metres(std::uint16_t room) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(room) << kRoomShift);
}

/// Returns Ray::room for a distance of at least 0 metres, rounded up by at most a sixteenth. 0 for 0 and for distances
/// below the smallest normal double; distances too large for the format become its largest value.
inline std::uint16_t ray_room(double metres) {
  if (!(metres >= std::numeric_limits<double>::min())) return 0;
  metres = std::fmin(metres, 0x1.fp1023);
  constexpr std::uint64_t kRest = (std::uint64_t{1} << kRoomShift) - 1;
  return static_cast<std::uint16_t>((std::bit_cast<std::uint64_t>(metres) + kRest) >> kRoomShift);
}

}  // namespace scarp
