// SPDX-License-Identifier: MIT
// Octant cubes, row by row in vectors of bytes, where they are stored.
//
//   along x   how far the next solid voxel of the same row is (voxel_nearness.h)
//   along y   in each slab: the least of that and 1 + the row ahead, its voxel and the next one along x
//   along z   the least of that and 1 + the slab ahead: its row, the row ahead of that, and the next voxels along x
//
// That is exact: what the slab ahead tells changes by 1 from voxel to voxel at most, so nothing of it need go along x
// and y again. Octants that differ in z alone share all but the last step.
#pragma once

#include "scarp/accel/voxel_bytes.h"
#include "scarp/accel/voxel_nearness.h"

namespace scarp {

struct OctantRows {
  int octant;
  bool and_opposite;             ///< also the octant that differs in z alone
  const VoxelNearness* along_x;  ///< of the region, spread from the side that is ahead: lower voxels where bit 0 is set
};

/// Writes the sides of the voxels of `region`. Sides ahead of the region are known. `sides`: one grid above the other,
/// by octant. Returns the largest side written.
int build_octants(const OctantRows& which, const VoxelBox& region, VoxelBytes& sides);

}  // namespace scarp
