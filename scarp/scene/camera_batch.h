// SPDX-License-Identifier: MIT
// Private to the station: which rays of a batch are those of a camera, laid out as the part of its picture that they
// are of.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scarp/base/ray.h"
#include "scarp/march/voxel/voxel_pictures_vk.h"

namespace scarp {

struct CameraBatch {
  static constexpr std::uint32_t kNone = 0xffff'ffff;

  VoxelPicture picture;             ///< the part
  std::vector<std::uint32_t> ray;   ///< of each pixel, row by row; kNone: there is none
  std::vector<std::size_t> others;  ///< rays that are not in it
};

/// Returns nothing if few rays are the camera's, or they are scattered over its picture.
std::optional<CameraBatch> camera_batch(const VoxelPicture& picture, std::span<const Ray> rays);

}  // namespace scarp
