// SPDX-License-Identifier: MIT
// A grid of voxels as an OpenVDB file.
#pragma once

#include "scarp/field/voxel_grid.h"
#include "scarp/source/vdb_file.h"

namespace scarp {

/// Of a grid whose corner is at the voxel `low` of the world, with voxels of `side` metres. Without colours.
VdbVoxels vdb_of(const VoxelGrid& grid, const ivec3& low, double side);

}  // namespace scarp
