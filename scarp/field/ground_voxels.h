// SPDX-License-Identifier: MIT
// Builds voxel ground column by column: large grids without visiting each voxel.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "scarp/field/voxel_grid.h"

namespace scarp {

/// Returns a grid in which column (x, y) is solid below tops[x + size.x * y], in voxels: 0 for none, at most size.z.
/// Voxels that are visible from above or from the side have the entry that `entry` returns; hidden voxels have entry 0.
/// `entry` is called concurrently. Throws Error as VoxelGrid does, for a wrong number of columns, or for a top out of
/// range.
VoxelGrid ground_voxels(const ivec3& size, std::span<const std::int32_t> tops, int entry_bits,
                        const std::function<std::uint32_t(const ivec3&)>& entry);

}  // namespace scarp
