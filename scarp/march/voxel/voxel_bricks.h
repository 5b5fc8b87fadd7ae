// SPDX-License-Identifier: MIT
// `voxel-bricks`: skips the largest empty block in a hierarchy of bit masks.
//
//   sector  16 x 16 x 16 voxels   a bit per brick
//   brick    4 x  4 x  4 voxels   a bit per voxel, those of the grid itself
//   and in both, 2 x 2 x 2 bits that are all 0 form one block of twice the size. Grids with a side above 512 have
//   levels of 64, 256, ... voxels, too. There rays descend from the largest cell that they have just entered
//
// In a brick only voxels ahead count: rays leave a brick at once if all its solid voxels are behind the ray's octant.
//
// Guarantee: exact. Requires BrickMasks, 1/64 of the size of the grid's own masks. Sources: the 64-trees of
// dubiousconst282, "A guide to fast voxel ray tracing using sparse 64-trees"; brick maps after J. van Wingerden, 2015.
// Cost: a step per block.
#pragma once

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

VoxelHit march_voxel_bricks(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats = nullptr);
bool occluded_voxel_bricks(const VoxelTarget& target, const QuantisedRay& ray);

/// As march_voxel_bricks(), recorded: adds to `trace`.
VoxelHit traced_voxel_bricks(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats, MarchTrace& trace);

}  // namespace scarp
