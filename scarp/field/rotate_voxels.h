// SPDX-License-Identifier: MIT
// Rotates voxel grids by quarter turns.
#pragma once

#include "scarp/base/lattice_rotation.h"
#include "scarp/field/voxel_grid.h"

namespace scarp {

/// Returns the grid rotated about its centre and moved so that its box starts at 0: voxel v moves to rotated_voxel(v,
/// grid.size(), turn).
VoxelGrid rotated(const VoxelGrid& grid, const LatticeRotation& turn);

ivec3 rotated_voxel(const ivec3& voxel, const ivec3& size, const LatticeRotation& turn);

}  // namespace scarp
