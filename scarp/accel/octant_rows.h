// SPDX-License-Identifier: MIT
// Builds octant cubes row by row, in place, in byte vectors.
//
//   along x   distance to the next solid voxel of the same row (voxel_nearness.h)
//   along y   in each slab: the minimum of that and 1 + the row ahead: its voxel and the next one along x
//   along z   the minimum of that and 1 + the slab ahead: its row, the row ahead of that, and the next voxels along x
//
// This is exact: values of the slab ahead differ by at most 1 between adjacent voxels, so they need not spread along x
// and y again. Octants that differ only in z share all but the last step.
#pragma once

#include "scarp/accel/voxel_bytes.h"
#include "scarp/accel/voxel_nearness.h"

namespace scarp {

struct OctantRows {
  int octant;
  bool and_opposite;             ///< also computes the octant that differs only in z
  const VoxelNearness* along_x;  ///< of the region, spread from the side ahead: lower voxels if bit 0 is set
};

/// Writes the sides of the voxels of `region`; sides ahead of the region must be known. `sides` stacks one grid per
/// octant along z.
void build_octants(const OctantRows& which, const VoxelBox& region, VoxelBytes& sides);

}  // namespace scarp
