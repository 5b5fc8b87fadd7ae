// SPDX-License-Identifier: MIT
// Palette entry and file coordinates of the voxel that a ray hit.
#pragma once

#include <cstdint>
#include <optional>

#include "scarp/scene/scene.h"

namespace scarp {

/// Returns the index in its model's palette of the voxel that was hit. Nullopt for hits of other fields and for models
/// without a palette: the entries of their voxels are colours of 24 bits.
std::optional<std::uint32_t> palette_entry(const Scene& scene, const Hit& hit);

/// Returns the coordinates in its file of the voxel that was hit. Nullopt for hits of other fields. Without a file
/// these are Hit::voxel.
std::optional<ivec3> file_voxel(const Scene& scene, const Hit& hit);

}  // namespace scarp
