// SPDX-License-Identifier: MIT
// Updates octant cubes after an edit, row by row, as far as values change.
//
//   side = 1 + the least side of the 7 neighbours ahead, 0 for solid voxels
//
// A side thus changes only in the box of the edit, or if a neighbour ahead changes. Rows are visited from the box
// backwards; each is recomputed where the rows ahead of it have changed, and from there along x for as long as values
// change. Outside the box, old sides of 0 identify solid voxels. Cost: proportional to the values that change and those
// beside them.
#pragma once

#include "scarp/accel/voxel_bytes.h"
#include "scarp/accel/voxel_nearness.h"

namespace scarp {

/// Updates the sides of one octant. `solid` covers `changed`, a box in the grid, and has not been spread. `sides`
/// stacks one grid per octant along z.
void update_octant(int octant, const VoxelNearness& solid, const VoxelBox& changed, VoxelBytes& sides);

}  // namespace scarp
