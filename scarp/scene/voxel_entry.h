// SPDX-License-Identifier: MIT
// The palette entry of the voxel that a ray hit.
#pragma once

#include <cstdint>
#include <optional>

#include "scarp/scene/scene.h"

namespace scarp {

/// Returns the index in its model's palette of the voxel that was hit. Nullopt for hits of other fields and for models
/// without a palette: the entries of their voxels are colours of 24 bits.
std::optional<std::uint32_t> palette_entry(const Scene& scene, const Hit& hit);

}  // namespace scarp
