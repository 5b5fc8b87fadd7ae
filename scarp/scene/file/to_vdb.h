// SPDX-License-Identifier: MIT
// A grid of voxels as an OpenVDB file.
#pragma once

#include "scarp/field/voxel_grid.h"
#include "scarp/source/voxel/vdb_file.h"

namespace scarp {

/// Converts a grid without its colours. Its corner is at the world voxel `low`; voxels have a side of `side` metres.
VdbVoxels vdb_of(const VoxelGrid& grid, const ivec3& low, double side);

}  // namespace scarp
