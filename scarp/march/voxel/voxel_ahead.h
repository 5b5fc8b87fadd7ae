// SPDX-License-Identifier: MIT
// The 4 x 4 x 4 bits of a brick or a sector, for `voxel-bricks`: bit = x + 4 y + 16 z.
#pragma once

#include <array>
#include <cstdint>

namespace scarp {

// A block of 2 x 2 x 2 starts at a bit with x, y and z even.
constexpr int kEven = 0b101010;
constexpr std::uint64_t kPair = 0x00330033;

// kAhead[octant][bit]: the voxels of a brick that a ray can still reach from one of them; bit i of an octant is set if
// the ray travels in the negative direction of axis i.
using Ahead = std::array<std::array<std::uint64_t, 64>, 8>;
constexpr Ahead make_ahead() {
  Ahead ahead{};
  for (int octant = 0; octant < 8; ++octant) {
    for (int from = 0; from < 64; ++from) {
      for (int to = 0; to < 64; ++to) {
        bool reached = true;
        for (int axis = 0; axis < 3; ++axis) {
          const int a = from >> (2 * axis) & 3, b = to >> (2 * axis) & 3;
          reached = reached && (octant >> axis & 1 ? b <= a : b >= a);
        }
        if (reached) ahead[octant][from] |= std::uint64_t{1} << to;
      }
    }
  }
  return ahead;
}
inline constexpr Ahead kAhead = make_ahead();

}  // namespace scarp
