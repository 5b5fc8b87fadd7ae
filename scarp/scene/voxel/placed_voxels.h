// SPDX-License-Identifier: MIT
// Voxel models with their placements: the input of scene_voxels(), and the result of readers.
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "scarp/base/world_box.h"
#include "scarp/march/voxel/voxel_target.h"
#include "scarp/scene/voxel/voxel_model.h"

namespace scarp {

/// Placement of a model: p_field = world_from_grid * p_grid + origin.
struct VoxelPlace {
  std::uint32_t model = 0;     ///< index into the models
  dmat3 world_from_grid{1.0};  ///< a rotation or reflection times the side of a voxel in metres, > 0
  dvec3 origin{0.0};           ///< metres, of the grid's corner (0, 0, 0)
};

/// Models are shared with the caller. After an edit of a model, scenes that contain it throw Error until they are built
/// again; LiveScene (live_scene.h) supports edits.
struct PlacedVoxels {
  std::vector<std::shared_ptr<const VoxelModel>> models{};
  std::vector<VoxelPlace> places{};
  VoxelRounding rounding{};
};

/// The box around a placed box of a grid.
WorldBox world_box(const VoxelPlace& place, const VoxelBox& box);
/// The box around all solid voxels; empty if there are none.
WorldBox world_box(const PlacedVoxels& voxels);

/// Options of readers for the models of files.
struct VoxelFileOptions {
  std::string_view march{};      ///< name in voxel_marches(); empty: see file_voxel_march()
  bool surface_colours = false;  ///< VoxelGrid::drop_hidden_entries(): saves memory; interior colours are lost
  VoxelRounding rounding{};
};

/// Returns the march with this name or, if it is empty, the default for grids of these sizes: `voxel-octants` up to
/// 2^20 voxels in total and 512 per side, else `voxel-bricks`. Octants are the fastest for small models, but take eight
/// bytes per voxel and more time to build. Throws Error if there is no such march.
const VoxelMarchEntry& file_voxel_march(std::string_view name, std::span<const ivec3> sizes);

}  // namespace scarp
