// SPDX-License-Identifier: MIT
// `voxel-cubes-jump`: the cube march as published by its author, the baseline for voxel-cubes.
//
//   +---+---+---+---+---+
//   |   |   |   |   |###|     D = 2: the ray leaves the voxel and travels D - 1 along its own direction; where it is
//   +---+---+---+---+---+     oblique, that ends up to sqrt(3) short of the border of the empty cube
//   |   | v |-,-x |   |
//   +---+---+---+---+---+
//
// Guarantee: exact, unlike the original, because the end point is computed in integers, as in voxel-spheres. Requires
// EmptyCubes. Source: C. Leak, "Raymarching voxel rendering". Cost: a step per jump, a quarter to a third more than
// voxel-cubes.
#pragma once

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

VoxelHit march_voxel_cubes_jump(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats = nullptr);
bool occluded_voxel_cubes_jump(const VoxelTarget& target, const QuantisedRay& ray);

/// As march_voxel_cubes_jump(), recorded: adds to `trace`.
VoxelHit traced_voxel_cubes_jump(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats,
                                 MarchTrace& trace);

}  // namespace scarp
