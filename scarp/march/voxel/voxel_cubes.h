// SPDX-License-Identifier: MIT
// `voxel-cubes`: skips the largest empty cube around each voxel.
//
//   +---+---+---+---+---+
//   |   |   |   |   |###|     D = 2: the nearest solid voxel is at Chebyshev distance 2; the cube of radius D - 1
//   +---+---+---+---+---+     is empty, and the ray advances to the cube's border
//   |   | v | ,-|-x-|---|->
//   +---+---+---+---+---+
//
// Guarantee: exact. Requires EmptyCubes. Source: cube-assisted raymarching as in C. Leak, "Raymarching voxel
// rendering". Unlike there, the ray advances to the border of the cube, not D - 1 along its length. Cost: a step per
// cube.
#pragma once

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

VoxelHit march_voxel_cubes(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats = nullptr);
bool occluded_voxel_cubes(const VoxelTarget& target, const QuantisedRay& ray);

/// As march_voxel_cubes(), recorded: adds to `trace`.
VoxelHit traced_voxel_cubes(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats, MarchTrace& trace);

}  // namespace scarp
