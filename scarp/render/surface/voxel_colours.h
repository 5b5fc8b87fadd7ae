// SPDX-License-Identifier: MIT
// The colours of a scene's surfaces as entries of voxels.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "scarp/scene/material.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// Returns the RGB colour of a surface's material, sRGB, red in the lowest 8 bits, as voxelised() and VoxelModel
/// expect. Throws Error for invalid materials.
std::function<std::uint32_t(const SceneSurface&)> voxel_colours(std::span<const Material> materials);

}  // namespace scarp
