// SPDX-License-Identifier: MIT
// `voxel-spheres`: travels through the empty sphere around each voxel, and on to the next plane.
//
//   +---+---+---+---+      the distance r from a voxel to the nearest solid one holds for each of its points: the ray
//   |   | . |   |###|      leaves the voxel and travels r further
//   +---.---.---+###+
//   | .-|-x-|-.-|---|->
//   +---+---+---+---+
//
// Guarantee: exact. Requires EmptySpheres. Source: sphere-assisted raymarching as in C. Leak, "Raymarching voxel
// rendering". Unlike there, r is rounded down instead of up, and the end point is computed in integers. Cost: a step
// per sphere.
#pragma once

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

VoxelHit march_voxel_spheres(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats = nullptr);
bool occluded_voxel_spheres(const VoxelTarget& target, const QuantisedRay& ray);

/// As march_voxel_spheres(), recorded: adds to `trace`.
VoxelHit traced_voxel_spheres(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats, MarchTrace& trace);

}  // namespace scarp
