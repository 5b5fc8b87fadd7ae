// SPDX-License-Identifier: MIT
// Distances to the nearest solid box, row by row in vectors: builds empty spheres.
//
//   along x   nearness of the nearest solid voxel of the same row (voxel_nearness.h), over nine rows for boxes of solid
//             voxels dilated by one; the square of that distance
//   along y   minimum over the rows of a slab of their square plus the square of their distance, searched outwards
//   along z   the same with slabs; the root, rounded down
//
// Rows and slabs without a solid voxel are skipped. A search ends when the squared distance of the next row, plus the
// least square of all rows, exceeds the result in each lane: the work depends on the distances found, not on the side
// of the grid. Exact in 16-bit integers. Source: T. Saito, J. Toriwaki, "New algorithms for Euclidean distance
// transformation of an n-dimensional digitized picture with applications", Pattern Recognition 1994.
//
// After an edit, a distance changes only if the box of the edit is at most as far away as the nearest solid voxel was.
// Towards the box, both distances decrease together, apart from the rounding of distances and positions: slabs are
// searched from the box outwards, and in them the rows next to those found.
#pragma once

#include "scarp/accel/voxel_bytes.h"
#include "scarp/accel/voxel_nearness.h"

namespace scarp {

/// Voxels that an edit may change.
struct SphereEdit {
  VoxelBox region;  ///< box around them
  int most = 0;     ///< their largest distance
};

/// Returns the voxels whose distances an edit in the box `changed` of the grid may change.
SphereEdit find_spheres(const VoxelBox& changed, const VoxelBytes& distances);

/// The voxels that build_spheres() writes, and those that it reads.
struct SphereRows {
  VoxelBox window;                    ///< solid voxels that are considered; includes the region along x
  VoxelBox region;                    ///< voxels to write
  const VoxelBox* changed = nullptr;  ///< skips voxels that an edit in this box does not change; null: writes all
  bool only_added = false;            ///< the edit removed nothing: distances do not increase
};

/// Writes distances: at most EmptySpheres::kFarthest, and kSolid for solid voxels. `along_x` holds the rows of the
/// window, spread along x from both sides. Results are exact up to the distance by which the window exceeds the region,
/// or for `only_added` if it includes the box of the edit, grown by one; others may be too large. Returns the largest
/// distance written.
int build_spheres(const VoxelNearness& along_x, const SphereRows& rows, VoxelBytes& distances);

}  // namespace scarp
