// SPDX-License-Identifier: MIT
// Emission and reflection of voxels.
#pragma once

namespace scarp {

/// A material of voxels. Light is not carried from voxel to voxel: neighbours of a voxel that emits stay dark.
struct VoxelMaterial {
  float emission = 0;  ///< light that the surface emits, in units of its colour under full light, >= 0
  float mirror = 0;    ///< fraction of the light that it mirrors, tinted by its colour, 0..1

  bool plain() const { return emission == 0 && mirror == 0; }
};

}  // namespace scarp
