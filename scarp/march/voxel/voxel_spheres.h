// SPDX-License-Identifier: MIT
// `voxel-spheres`: over the empty sphere around each voxel, and on to the next plane.
//
//   +---+---+---+---+      the distance r from a voxel to the nearest solid one holds for each of its points:
//   |   | . |   |###|      the ray leaves the voxel and travels r further
//   +---.---.---+###+
//   | .-|-x-|-.-|---|->
//   +---+---+---+---+
//
// Guarantee: exact. Needs EmptySpheres. Source: sphere-assisted raymarching of C. Leak, "Raymarching voxel rendering".
// Other than there, r is rounded down and not up, and where the travel ends is found in whole numbers. Cost: a step per
// sphere.
#pragma once

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

VoxelHit march_voxel_spheres(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats = nullptr);
bool occluded_voxel_spheres(const VoxelTarget& target, const QuantisedRay& ray);

}  // namespace scarp
