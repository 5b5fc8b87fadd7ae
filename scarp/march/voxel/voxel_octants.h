// SPDX-License-Identifier: MIT
// `voxel-octants`: out of the largest empty cube that lies ahead of each voxel.
//
//   +---+---+---+---+
//   |   |   |   |###|     eight cubes per voxel, one for each octant that a direction can point into, each with the
//   +---+---+---+---+     voxel in the corner that rays come from: what lies behind the ray does not count
//   | v | ,-|---|-x-|->
//   +---+---+---+---+
//
// Guarantee: exact. Needs OctantCubes. Source: L. Deakin, M. Knackstedt, "Accelerated volume rendering with Chebyshev
// distance maps", SIGGRAPH Asia 2019, which keeps them for blocks. Cost: a step per cube, a fifth fewer than
// voxel-cubes.
#pragma once

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

VoxelHit march_voxel_octants(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats = nullptr);
bool occluded_voxel_octants(const VoxelTarget& target, const QuantisedRay& ray);

}  // namespace scarp
