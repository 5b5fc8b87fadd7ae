// SPDX-License-Identifier: MIT
// Distances to the nearest solid box, row by row in vectors: what empty spheres are built from.
//
//   along x   how near the nearest solid voxel of the same row is (voxel_nearness.h); of nine rows, for boxes of solid
//             voxels grown by one; the square of that distance
//   along y   least square of the rows of a slab, each plus the square of how far it is away, looked for outwards
//   along z   the same with the slabs; the root, rounded down
//
// It ends where the square of how far rows are away is more than what has been found in each lane, so the work is that
// of the distances there are, not of the grid's side. Exact in whole numbers of 16 bits. Source: T. Saito, J. Toriwaki,
// "New algorithms for Euclidean distance transformation of an n-dimensional digitized picture with applications",
// Pattern Recognition 1994.
#pragma once

#include "scarp/accel/voxel_bytes.h"
#include "scarp/accel/voxel_nearness.h"

namespace scarp {

/// Writes the distances of the voxels of `region`, EmptySpheres::kFarthest at most and kSolid in solid ones. `along_x`
/// holds the rows of `window`, spread along x from both sides, in which all that is nearer than kFarthest stands.
/// Returns the largest distance written to empty voxels.
int build_spheres(const VoxelNearness& along_x, const VoxelBox& window, const VoxelBox& region, VoxelBytes& distances);

}  // namespace scarp
