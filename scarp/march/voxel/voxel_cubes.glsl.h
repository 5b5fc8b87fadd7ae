// SPDX-License-Identifier: MIT
// `voxel-cubes` and, with cubes ahead of each voxel, `voxel-octants` in shaders (voxel_cubes.h, voxel_octants.h).
// Compiles as C++ and GLSL. The host defines scarp_voxel_byte().
#ifndef SCARP_MARCH_VOXEL_CUBES_GLSL_H
#define SCARP_MARCH_VOXEL_CUBES_GLSL_H

#include "scarp/march/voxel/voxel_walk.glsl.h"

SCARP_GLSL_BEGIN

/// EmptyCubes::distance(), OctantCubes::side() or EmptySpheres::distance() of a voxel. The octant is that of the ray.
#ifdef __cplusplus
uint scarp_voxel_byte(const ivec3& voxel, uint octant);
#endif

/// Both cubes end that many planes ahead of the voxel along every axis, in the ray's direction.
SCARP_FN bool scarp_cubes_turn(SCARP_INOUT(ScarpVoxelWalk) walk, SCARP_OUT(bool) solid) {
  int side = int(scarp_voxel_byte(walk.voxel, walk.back & 7u));
  solid = side == 0;
  bool inside = false;
  if (side == 1) {
    inside = scarp_voxel_cross(walk);
  } else if (!solid) {
    inside = scarp_voxel_leave(walk, ivec3(side));
  }
  return inside;
}

SCARP_GLSL_END

#endif
