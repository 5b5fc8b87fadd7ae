// SPDX-License-Identifier: MIT
// Octant cubes, row by row in vectors of bytes.
//
//   ahead in z   C B      near = max(that along x of the same row, max(A, B, C and theirs next in x) - 1)
//   same slab    A *      A: the row ahead in y; B, C: the same two in the slab ahead
//
// Nearness is 255 - side. Along x each row's own solid voxels are spread first; A, B and C hold no steeper steps than
// 1, nor does what becomes of them, so nothing need be spread along x again. Octants take turns, for each row waits for
// the one before it.
#pragma once

#include <span>

#include "scarp/accel/voxel_bytes.h"
#include "scarp/accel/voxel_nearness.h"

namespace scarp {

struct OctantRows {
  int octant;
  const VoxelNearness* along_x;  ///< of a region, spread from the side that is ahead: lower voxels where bit 0 is set
};

/// Writes the sides of the voxels of `region` for 1 to 8 octants. Sides ahead of the region are known. `sides`: one
/// grid above the other, by octant. Returns the largest side written.
int build_octants(std::span<const OctantRows> octants, const VoxelBox& region, VoxelBytes& sides);

}  // namespace scarp
