// SPDX-License-Identifier: MIT
// `voxel-planes`: from plane to plane, voxel by voxel.
//
//   +---+---+---+---+
//   |   |   | ,-x---|---   x: a plane is crossed, the voxel behind it is looked at
//   +---+-,-x---+---+
//   | ,-x   |   |   |
//   x---+---+---+---+
//
// Guarantee: exact. Needs nothing built. Source: J. Amanatides, A. Woo, "A fast voxel traversal algorithm for ray
// tracing", Eurographics 1987; the plane marching of C. Leak, "Raymarching voxel rendering". Other than there, t
// decides only which plane is next, by a comparison of whole numbers: there is no epsilon. Cost: a step per plane.
#pragma once

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

VoxelHit march_voxel_planes(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats = nullptr);
bool occluded_voxel_planes(const VoxelTarget& target, const QuantisedRay& ray);

}  // namespace scarp
