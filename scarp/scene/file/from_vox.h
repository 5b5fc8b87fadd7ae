// SPDX-License-Identifier: MIT
// The scene of a .vox file as models in their places, in metres: a voxel 1 m, z up as in the file.
#pragma once

#include "scarp/scene/placed_voxels.h"
#include "scarp/source/vox_scene.h"

namespace scarp {

struct FromVoxOptions {
  VoxSceneOptions scene{};
  VoxelFileOptions voxels{};
};

/// Entries are palette indices. Where instances overlap, one voxel is left in each place, that which MagicaVoxel shows:
/// of the instance that comes first in files from version 200 on, and last in those before. An instance that loses
/// voxels so has a model of its own. Grids are models cut to the least box around their voxels. Throws Error: no such
/// march, more overlaps than can be settled, models that together span more than 2^34 voxels.
PlacedVoxels placed_voxels_from(const VoxFile& file, const FromVoxOptions& options = {});

}  // namespace scarp
