// SPDX-License-Identifier: MIT
// Voxels of OpenVDB files as one model, with the position and size given in the file.
#pragma once

#include "scarp/scene/file/from_volume.h"
#include "scarp/scene/voxel/placed_voxels.h"
#include "scarp/source/voxel/vdb_file.h"

namespace scarp {

/// A voxel is the cube around its grid point in the file. Entries are RGB in 24 bits; without colours, all voxels are
/// plain. Throws Error for an unknown march, no solid voxel, a grid too large for the march, or more than 4 GiB of
/// memory, before it is allocated.
PlacedVoxels placed_voxels_from(const VdbVoxels& file, const VoxelFileOptions& options = {}, UpAxis up = UpAxis::z);

}  // namespace scarp
