// SPDX-License-Identifier: MIT
// The current camera, for a scene on a device whose voxels are drawn (VoxelDrawing::proxies):
//
//   const auto sight = std::make_shared<VoxelSight>(VoxelSight{VoxelDrawing::proxies});
//   const Scene there = scene_on(device, scene, sight);
//   sight->picture = ...;                               // before each picture
//
// In batches of free rays, those of the camera are then traced by drawing boxes, all others by compute, with the same
// results. A ray is one of the camera if it has its origin and a pixel that no other ray of the batch has.
#pragma once

#include <cstdint>

#include "scarp/march/voxel/voxel_pictures_vk.h"

namespace scarp {

struct VoxelSight {
  VoxelDrawing drawing = VoxelDrawing::compute;
  VoxelPicture picture{};   ///< a pixel per sample
  std::uint64_t drawn = 0;  ///< number of rays traced by drawing so far
};

}  // namespace scarp
