// SPDX-License-Identifier: MIT
// A grid of voxels as a MagicaVoxel document.
#pragma once

#include "scarp/field/voxel_grid.h"
#include "scarp/source/vox_file.h"

namespace scarp {

/// Of a grid with RGB entries whose corner is at the voxel `low` of the world; in models of at most 256 a side, of
/// which empty ones are left out. Up to 255 colours are kept; of more (then `exact_colours` is false) each is the
/// nearest of 6 reds, 7 greens and 6 blues. Throws Error: entries of other widths, no solid voxel.
VoxFile vox_file_of(const VoxelGrid& grid, const ivec3& low, bool& exact_colours);

}  // namespace scarp
