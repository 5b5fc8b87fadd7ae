// SPDX-License-Identifier: MIT
// The colours of a scene's surfaces as entries of voxels.
#pragma once

#include <cstdint>
#include <functional>

#include "scarp/render/frame/scene_picture.h"

namespace scarp {

/// RGB of a surface's material, sRGB, red in the lowest 8 bits: what voxelised() and VoxelModel take. Throws Error for
/// materials that are none.
std::function<std::uint32_t(const SceneSurface&)> voxel_colours(const SceneLook& look);

}  // namespace scarp
