// SPDX-License-Identifier: MIT
// A grid of voxels as a MagicaVoxel document.
#pragma once

#include "scarp/field/voxel_grid.h"
#include "scarp/source/voxel/vox_file.h"

namespace scarp {

/// Converts a grid with RGB entries whose corner is at the world voxel `low`, into models of at most 256 voxels a side;
/// empty models are omitted. Keeps up to 255 colours; if there are more (`exact_colours` is then false), each becomes
/// the nearest of 6 reds, 7 greens and 6 blues. Throws Error for entries of another width, or no solid voxel.
VoxFile vox_file_of(const VoxelGrid& grid, const ivec3& low, bool& exact_colours);

}  // namespace scarp
