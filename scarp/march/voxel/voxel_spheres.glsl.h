// SPDX-License-Identifier: MIT
// `voxel-spheres` in shaders (voxel_spheres.h). Compiles as C++ and GLSL. The host's bytes are as for cubes.
#ifndef SCARP_MARCH_VOXEL_SPHERES_GLSL_H
#define SCARP_MARCH_VOXEL_SPHERES_GLSL_H

#include "scarp/march/voxel/voxel_cubes.glsl.h"

SCARP_GLSL_BEGIN

const uint kScarpSolidSphere = 255u;  ///< EmptySpheres::kSolid

/// `travel_per_voxel` is scarp_travel_per_voxel() of the ray.
SCARP_FN bool scarp_spheres_turn(SCARP_INOUT(ScarpVoxelWalk) walk, uint travel_per_voxel, SCARP_OUT(bool) solid) {
  uint radius = scarp_voxel_byte(walk.voxel, walk.back & 7u);
  solid = radius == kScarpSolidSphere;
  bool inside = false;
  if (!solid) inside = scarp_voxel_travel(walk, radius, travel_per_voxel);
  return inside;
}

SCARP_GLSL_END

#endif
