// SPDX-License-Identifier: MIT
// Grids turned by quarter turns.
#pragma once

#include "scarp/base/lattice_rotation.h"
#include "scarp/field/voxel_grid.h"

namespace scarp {

/// The grid turned about its own middle and moved so that its box begins at 0 again: voxel v comes to stand at
/// rotated_voxel(v, grid.size(), turn).
VoxelGrid rotated(const VoxelGrid& grid, const LatticeRotation& turn);

ivec3 rotated_voxel(const ivec3& voxel, const ivec3& size, const LatticeRotation& turn);

}  // namespace scarp
