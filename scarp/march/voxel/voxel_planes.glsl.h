// SPDX-License-Identifier: MIT
// `voxel-planes` in shaders (voxel_planes.h). Compiles as C++ and GLSL, including GLSL ES 3.0. The host defines
// scarp_voxel_mask().
#ifndef SCARP_MARCH_VOXEL_PLANES_GLSL_H
#define SCARP_MARCH_VOXEL_PLANES_GLSL_H

#include "scarp/march/voxel/voxel_walk.glsl.h"

SCARP_GLSL_BEGIN

/// The mask of a brick, as VoxelGrid::mask(): the low word first.
#ifdef __cplusplus
uvec2 scarp_voxel_mask(const ivec3& brick);
#endif

/// VoxelGrid::bit_of(); also that of a brick in its sector.
SCARP_FN uint scarp_voxel_bit(ivec3 voxel) {
  return uint(voxel.x & 3) | uint(voxel.y & 3) << 2 | uint(voxel.z & 3) << 4;
}
/// Returns whether a bit is set.
SCARP_FN bool scarp_mask_has(uvec2 mask, uint bit) { return ((bit < 32u ? mask.x : mask.y) >> (bit & 31u) & 1u) != 0u; }

/// Advances by one step and returns whether the ray is still in the box, or sets `solid`.
SCARP_FN bool scarp_planes_turn(SCARP_INOUT(ScarpVoxelWalk) walk, SCARP_OUT(bool) solid) {
  ivec3 brick = ivec3(walk.voxel.x >> 2, walk.voxel.y >> 2, walk.voxel.z >> 2);
  solid = scarp_mask_has(scarp_voxel_mask(brick), scarp_voxel_bit(walk.voxel));
  bool inside = false;
  if (!solid) inside = scarp_voxel_cross(walk);
  return inside;
}

SCARP_GLSL_END

#endif
