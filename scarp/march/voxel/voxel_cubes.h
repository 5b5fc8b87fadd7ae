// SPDX-License-Identifier: MIT
// `voxel-cubes`: out of the largest empty cube around each voxel.
//
//   +---+---+---+---+---+
//   |   |   |   |   |###|     D = 2: the nearest solid voxel is two away in the axis where it is farthest;
//   +---+---+---+---+---+     the cube of radius D - 1 is empty, and the ray goes to where it leaves it
//   |   | v | ,-|-x-|---|->
//   +---+---+---+---+---+
//
// Guarantee: exact. Needs EmptyCubes. Source: cube-assisted raymarching of C. Leak, "Raymarching voxel rendering".
// Other than there, the ray goes to the very border of the cube, not D - 1 along its length. Cost: a step per cube.
#pragma once

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

VoxelHit march_voxel_cubes(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats = nullptr);
bool occluded_voxel_cubes(const VoxelTarget& target, const QuantisedRay& ray);

}  // namespace scarp
