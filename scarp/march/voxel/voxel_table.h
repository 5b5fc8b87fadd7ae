// SPDX-License-Identifier: MIT
// The marches of voxel grids.
#pragma once

#include <span>
#include <string_view>

#include "scarp/march/march_entry.h"
#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

/// The member of VoxelTarget that a voxel march requires besides the grid.
enum class VoxelAccelerator { none, spheres, cubes, octants, bricks };

/// As VoxelMarch; `trace` receives the steps of the march, after what it contains.
using VoxelMarchTraced = VoxelHit (*)(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats,
                                      MarchTrace& trace);

/// A row. `cpu` and `occluded` are not null: a technique without its own any-hit query gets one based on `cpu`.
struct VoxelMarchEntry : MarchEntry {
  VoxelAccelerator accelerator = VoxelAccelerator::none;
  VoxelMarch cpu = nullptr;  ///< scalar C++
  VoxelOcclusion occluded = nullptr;
  VoxelPacketMarch packet = nullptr;  ///< many rays at once in vectors; given if `simd`
  VoxelMarchTraced traced = nullptr;  ///< null if the march records nothing
};

/// The oracle, `voxel-exhaustive`, comes first.
std::span<const VoxelMarchEntry> voxel_marches();
/// Throws Error listing the names if the march is unknown.
const VoxelMarchEntry& find_voxel_march(std::string_view name);

}  // namespace scarp
