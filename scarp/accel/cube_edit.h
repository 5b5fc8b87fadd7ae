// SPDX-License-Identifier: MIT
// Updates empty cubes after an edit, row by row, where distances may change.
//
// A distance changes only if the box of the edit is at most as far away as the nearest solid voxel was. The search for
// these voxels goes outwards from the box: a step towards the box lowers both distances by one, so a voxel behind
// another one that keeps its distance keeps its own. Their distances restart at 255; one pass with rising and one with
// falling coordinates then spread distances among them and from their neighbours. Source of the passes: A. Rosenfeld,
// J. Pfaltz, "Distance functions on digital pictures", Pattern Recognition 1968. Cost: proportional to the rows of
// these voxels, for any content of the grid.
#pragma once

#include "scarp/accel/voxel_bytes.h"
#include "scarp/accel/voxel_nearness.h"

namespace scarp {

/// Updates `distances`. `solid` covers `changed`, a box in the grid, and has not been spread.
void update_cubes(const VoxelNearness& solid, const VoxelBox& changed, VoxelBytes& distances);

}  // namespace scarp
