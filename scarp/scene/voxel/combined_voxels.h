// SPDX-License-Identifier: MIT
// Union, intersection and difference of placed voxels that share one lattice.
#pragma once

#include <span>

#include "scarp/scene/voxel/placed_voxels.h"

namespace scarp {

/// Operation that combines voxels.
enum class VoxelCombination {
  unite,      ///< solid in any part
  intersect,  ///< solid in all parts
  subtract,   ///< solid in the first part and in no other
};

/// Combines parts into one model with RGB entries. The first place of the first non-empty part defines the lattice: all
/// other places must be offset by whole voxels and rotated by quarter turns, with voxels of the same size, within 10^-6
/// of a voxel. Where parts overlap, the first part that is solid there determines the colour. An empty result has no
/// places. Throws Error naming the part that is not on the lattice, or if a side of the result is longer than
/// VoxelGrid::kMaxModelSide.
PlacedVoxels combined_voxels(VoxelCombination combination, std::span<const PlacedVoxels> parts,
                             const VoxelFileOptions& options = {});

}  // namespace scarp
