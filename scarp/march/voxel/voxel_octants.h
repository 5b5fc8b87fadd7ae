// SPDX-License-Identifier: MIT
// `voxel-octants`: skips the largest empty cube ahead of each voxel.
//
//   +---+---+---+---+
//   |   |   |   |###|     eight cubes per voxel, one per octant of directions, each with the voxel in the corner where
//   +---+---+---+---+     rays enter: voxels behind the ray do not count
//   | v | ,-|---|-x-|->
//   +---+---+---+---+
//
// Guarantee: exact. Requires OctantCubes. Source: L. Deakin, M. Knackstedt, "Accelerated volume rendering with
// Chebyshev distance maps", SIGGRAPH Asia 2019, which stores them for blocks. Cost: a step per cube, a fifth fewer than
// voxel-cubes.
#pragma once

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

VoxelHit march_voxel_octants(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats = nullptr);
bool occluded_voxel_octants(const VoxelTarget& target, const QuantisedRay& ray);

/// As march_voxel_octants(), recorded: adds to `trace`.
VoxelHit traced_voxel_octants(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats, MarchTrace& trace);

}  // namespace scarp
