// SPDX-License-Identifier: MIT
// Private to the station: finds the rays of a batch that come from a camera, and arranges them as the part of the
// picture that they cover.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scarp/base/ray.h"
#include "scarp/march/voxel/voxel_drawing.h"

namespace scarp {

struct CameraBatch {
  static constexpr std::uint32_t kNone = 0xffff'ffff;

  VoxelPicture picture;             ///< the part
  std::vector<std::uint32_t> ray;   ///< ray of each pixel, row by row; kNone: no ray
  std::vector<std::size_t> others;  ///< rays that are not in the part
};

/// Returns nullopt if few of the rays come from the camera, or if they are scattered over its picture.
std::optional<CameraBatch> camera_batch(const VoxelPicture& picture, std::span<const Ray> rays);

}  // namespace scarp
