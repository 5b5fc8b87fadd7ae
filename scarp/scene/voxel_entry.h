// SPDX-License-Identifier: MIT
// Palette entry and file coordinates of the voxel that a ray hit.
#pragma once

#include <cstdint>
#include <optional>

#include "scarp/scene/scene.h"

namespace scarp {

/// Returns the palette index of the voxel that was hit, in its model's palette. Returns nullopt for hits on other
/// fields and for models without a palette, whose entries are 24-bit colours.
std::optional<std::uint32_t> palette_entry(const Scene& scene, const Hit& hit);

/// Returns the coordinates in its file of the voxel that was hit. Returns nullopt for hits on other fields. Without a
/// file, the coordinates are Hit::voxel.
std::optional<ivec3> file_voxel(const Scene& scene, const Hit& hit);

}  // namespace scarp
