// SPDX-License-Identifier: MIT
// `voxel-planes`: from plane to plane, voxel by voxel.
//
//   +---+---+---+---+
//   |   |   | ,-x---|---   x: the ray crosses a plane, and the voxel behind it is tested
//   +---+-,-x---+---+
//   | ,-x   |   |   |
//   x---+---+---+---+
//
// Guarantee: exact. Requires no accelerator. Source: J. Amanatides, A. Woo, "A fast voxel traversal algorithm for ray
// tracing", Eurographics 1987; the plane marching of C. Leak, "Raymarching voxel rendering". Unlike there, t only
// orders the planes, by an integer comparison: there is no epsilon. Cost: a step per plane.
#pragma once

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

VoxelHit march_voxel_planes(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats = nullptr);
/// The same, with a filter that decides which voxels count.
VoxelHit march_voxel_planes_accepted(const VoxelTarget& target, const QuantisedRay& ray, const VoxelFilter& accept,
                                     MarchStats* stats = nullptr);
bool occluded_voxel_planes(const VoxelTarget& target, const QuantisedRay& ray);

/// As march_voxel_planes(), recorded: adds to `trace`.
VoxelHit traced_voxel_planes(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats, MarchTrace& trace);

}  // namespace scarp
