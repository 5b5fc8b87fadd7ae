// SPDX-License-Identifier: MIT
// An ordered pattern in space, for voxels of which a fraction is solid: every four voxels along an axis have the ranks
// 0, 1, 2 and 3, so with k ranks solid, k of every four voxels along any axis are solid. The pattern is shifted
// randomly in each block of 4 x 4 x 4; otherwise large areas would show stripes. (Ordered dithering after B. Bayer,
// 1973, in space.)
#pragma once

#include <cstdint>

#include "scarp/base/vec.h"

namespace scarp {

/// Returns 0 to 3. Each rank occurs once in every run of four voxels along an axis that starts at a multiple of 4.
inline int ordered_rank(const ivec3& voxel) {
  const ivec3 of = voxel >> 2;
  std::uint32_t moved = static_cast<std::uint32_t>(of.x) * 0x9E3779B1U ^
                        static_cast<std::uint32_t>(of.y) * 0x85EBCA77U ^ static_cast<std::uint32_t>(of.z) * 0xC2B2AE3DU;
  moved = (moved ^ moved >> 15) * 0x2C1B3C6DU;
  const int odd = (voxel.x + voxel.y + voxel.z) & 1;
  const int second = ((voxel.x >> 1) + (voxel.y >> 1) + (voxel.z >> 1)) & 1;
  return static_cast<int>((static_cast<std::uint32_t>(2 * odd + second) + (moved >> 20)) & 3);
}

}  // namespace scarp
