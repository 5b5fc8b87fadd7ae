// SPDX-License-Identifier: MIT
// Updates octant cubes after an edit, from row to row, as far as values change.
//
//   side = 1 + the least side of the 7 neighbours ahead, 0 for solid voxels
//
// A side thus changes only if a neighbour ahead changes, or in the box of the edit. Rows are visited from the box
// backwards; each is computed where the rows ahead of it have changed, and on along x while that changes anything.
// Outside the box, old sides of 0 identify solid voxels. Cost: the values that change, and those beside them.
#pragma once

#include "scarp/accel/voxel_bytes.h"
#include "scarp/accel/voxel_nearness.h"

namespace scarp {

/// `solid` covers `changed`, a box in the grid, and has not been spread. `sides` stacks one grid per octant along z.
void update_octant(int octant, const VoxelNearness& solid, const VoxelBox& changed, VoxelBytes& sides);

}  // namespace scarp
