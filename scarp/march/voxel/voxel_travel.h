// SPDX-License-Identifier: MIT
// Travel through empty space by a length, for voxel-spheres and voxel-cubes-jump.
#pragma once

#include <cmath>
#include <cstdint>

#include "scarp/march/voxel/voxel_ray.h"

namespace scarp {

/// Returns the travel along a ray's longest axis, in 2^-20 voxel, per voxel of length: rounded down, so that a ray
/// never travels too far.
inline std::int64_t travel_per_voxel(const QuantisedDirection& direction) {
  double square = 0;
  for (const std::int64_t speed : direction.speed) square += static_cast<double>(speed) * static_cast<double>(speed);
  const std::int64_t length = static_cast<std::int64_t>(std::sqrt(square)) + 2;
  return (std::int64_t{1} << (kPlaceBits + kDirectionBits)) / length;
}

}  // namespace scarp
