// SPDX-License-Identifier: MIT
// Distances to the nearest solid box, row by row in vectors: builds empty spheres.
//
//   along x   nearness of the nearest solid voxel of the same row (voxel_nearness.h), over nine rows for boxes of solid
//             voxels dilated by one; the square of that distance
//   along y   minimum over the rows of a slab of their square plus the square of their distance, searched outwards
//   along z   the same with slabs; the root, rounded down
//
// The search ends when the squared distance of the next rows exceeds the result in each lane, so the work depends on
// the distances found, not on the side of the grid. Exact in 16-bit integers. Source: T. Saito, J. Toriwaki, "New
// algorithms for Euclidean distance transformation of an n-dimensional digitized picture with applications", Pattern
// Recognition 1994.
#pragma once

#include "scarp/accel/voxel_bytes.h"
#include "scarp/accel/voxel_nearness.h"

namespace scarp {

/// Writes the distances of the voxels of `region`: at most EmptySpheres::kFarthest, and kSolid for solid ones.
/// `along_x` holds the rows of `window`, spread along x from both sides; the window must include everything nearer than
/// kFarthest. Returns the largest distance written to empty voxels.
int build_spheres(const VoxelNearness& along_x, const VoxelBox& window, const VoxelBox& region, VoxelBytes& distances);

}  // namespace scarp
