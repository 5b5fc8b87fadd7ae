// SPDX-License-Identifier: MIT
// Union, intersection and difference of placed voxels that share one lattice.
#pragma once

#include <span>

#include "scarp/scene/placed_voxels.h"

namespace scarp {

/// How to combine voxels.
enum class VoxelCombination {
  unite,      ///< solid in any part
  intersect,  ///< solid in all parts
  subtract,   ///< solid in the first part and in no other
};

/// Combines parts into one model with RGB entries, for a march of voxel_marches(). The lattice is that of the first
/// voxel of the first part: all other places must be whole voxels away from it, turned by quarter turns and with voxels
/// of the same size, within 10^-6 of a voxel. Where parts overlap, colours are those of the first part that is solid
/// there. An empty result has no places. Throws Error naming the part that is not on the lattice, or if a side of the
/// result is longer than VoxelGrid::kMaxSide.
PlacedVoxels combined_voxels(VoxelCombination combination, std::span<const PlacedVoxels> parts,
                             const VoxelFileOptions& options = {});

}  // namespace scarp
