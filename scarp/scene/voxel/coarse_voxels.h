// SPDX-License-Identifier: MIT
// Merges voxels that are smaller than pixels, 2 x 2 x 2 at a time: this leaves fewer voxels to march, and colours that
// are already averaged.
//
// The coverage of a block of 8 is measured along the axis along which it covers most: 0 to 4 of its 4 columns. Blocks
// that cover all 4 are solid: walls stay closed, however thin. The others are solid in proportion to their coverage:
// every second block in a row of single voxels, a quarter of them for scattered points. A model therefore covers the
// same area of a picture at every level; a majority vote of the 8 would lose thin parts, and "any of 8" would thicken
// them. An ordered pattern (ordered_pattern.h) selects the solid blocks: 1, 2 or 3 in each run of 4 along an axis.
//
// A block's colour is the mean, in linear light, of its voxels with an open face, or of all if none has one. Emitted
// light brightens it; coarse voxels mirror nothing.
#pragma once

#include <memory>

#include "scarp/scene/voxel/voxel_model.h"

namespace scarp {

/// Merges `level` times, with the same march and the same corner (0, 0, 0); entries are RGB. Level 0 is the model
/// itself. At level 12 nothing is left to merge.
std::shared_ptr<const VoxelModel> coarse_voxels(std::shared_ptr<const VoxelModel> model, int level);

}  // namespace scarp
