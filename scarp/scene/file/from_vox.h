// SPDX-License-Identifier: MIT
// The scene of a .vox file as placed models, in metres: voxels of 1 m, z up as in the file.
#pragma once

#include "scarp/scene/voxel/placed_voxels.h"
#include "scarp/source/voxel/vox_scene.h"

namespace scarp {

struct FromVoxOptions {
  VoxSceneOptions scene{};
  VoxelFileOptions voxels{};
};

/// Entries are palette indices. Materials of the file: colours that emit (_emit, doubled by each step of _flux) and
/// metals (_metal, reduced by _rough) become VoxelMaterial; all others, glass included, are opaque. An alpha of 1 to
/// 254 is the fraction of a colour's voxels that are solid, chosen by ordered_pattern.h. An alpha of 0 means opaque,
/// because many programs do not write alpha. Where instances overlap, one voxel remains at each position, the one that
/// MagicaVoxel shows: from the first instance in files of version 200 and later, from the last in older files. An
/// instance that loses voxels gets its own model; all others share the models of the file. If instances coincide, one
/// remains. Grids are models cut to the smallest box around their voxels. Throws Error for an unknown march, too many
/// overlaps, or more than 1 GiB of memory (16 bytes per voxel of the file if that is more), before it is allocated.
PlacedVoxels placed_voxels_from(const VoxFile& file, const FromVoxOptions& options = {});

}  // namespace scarp
