// SPDX-License-Identifier: MIT
// Voxels that are smaller than pixels, made one of 2 x 2 x 2 each: less to march, and colours that are means already.
//
// What a block of 8 covers is told along the axis along which it covers most: 0 to 4 of its 4 columns. Blocks that
// cover all 4 are solid: walls stay closed, however thin. Of the others as large a share is solid as they cover: of a
// row of single voxels every second block, of points scattered about a quarter. So what a model covers of a picture
// stays the same from level to level, where a vote of the 8 would lose what is thin and "any of 8" would fatten it.
// Which blocks those are: in each run of 4 blocks along an axis 1, 2 or 3, by an ordered pattern (ordered_pattern.h).
//
// A block's colour is the mean, in linear light, of its voxels with an open face; of all when none has one. Light
// that they emit brightens it; coarse voxels mirror nothing.
#pragma once

#include <memory>

#include "scarp/scene/voxel_model.h"

namespace scarp {

/// `level` times, with the same march and the same corner (0, 0, 0); entries are RGB. Level 0 is the model itself.
/// At level 12 nothing is left to be made one.
std::shared_ptr<const VoxelModel> coarse_voxels(std::shared_ptr<const VoxelModel> model, int level);

}  // namespace scarp
