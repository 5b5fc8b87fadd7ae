// SPDX-License-Identifier: MIT
// Where a camera looks, for a scene on a device whose voxels are drawn (VoxelDrawing::proxies):
//
//   const auto sight = std::make_shared<VoxelSight>(VoxelSight{VoxelDrawing::proxies});
//   const Scene there = scene_on(device, scene, sight);
//   sight->picture = ...;                               // before each picture
//
// Of batches of free rays, those of the camera are then answered by drawing boxes, all others by compute. Answers are
// the same. A ray is one of the camera if it has its origin and a pixel that no other ray of the batch has.
#pragma once

#include <cstdint>

#include "scarp/march/voxel/voxel_pictures_vk.h"

namespace scarp {

struct VoxelSight {
  VoxelDrawing drawing = VoxelDrawing::compute;
  VoxelPicture picture{};   ///< a pixel per sample
  std::uint64_t drawn = 0;  ///< rays so far that were answered by drawing
};

}  // namespace scarp
