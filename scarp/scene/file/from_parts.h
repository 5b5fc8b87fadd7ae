// SPDX-License-Identifier: MIT
// Files of listed voxels as models, one per part, in metres: voxels of 1 m, z up.
#pragma once

#include "scarp/scene/voxel/placed_voxels.h"
#include "scarp/source/voxel/voxel_parts.h"

namespace scarp {

/// Entries are RGB in 24 bits. Grids are parts cut to the smallest box around their voxels; empty parts are omitted.
/// Throws Error for an unknown march, or more than 1 GiB of memory (16 bytes per voxel if that is more), before it is
/// allocated.
PlacedVoxels placed_voxels_from(const VoxelParts& file, const VoxelFileOptions& options = {});

}  // namespace scarp
