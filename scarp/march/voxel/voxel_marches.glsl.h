// SPDX-License-Identifier: MIT
// The loop of all voxel marches in shaders. Compiles as C++ and GLSL, including GLSL ES 3.0. The host defines the
// functions that the marches require (voxel_planes.glsl.h, voxel_cubes.glsl.h, voxel_bricks.glsl.h).
#ifndef SCARP_MARCH_VOXEL_MARCHES_GLSL_H
#define SCARP_MARCH_VOXEL_MARCHES_GLSL_H

#include "scarp/accel/voxel_marks.glsl.h"
#include "scarp/march/voxel/voxel_bricks.glsl.h"
#include "scarp/march/voxel/voxel_cubes.glsl.h"
#include "scarp/march/voxel/voxel_planes.glsl.h"
#include "scarp/march/voxel/voxel_spheres.glsl.h"

SCARP_GLSL_BEGIN

/// Follows a ray to the first solid voxel. Returns false if there is none in the box, or `turns` steps do not reach it;
/// counts these down.
SCARP_FN bool scarp_first_voxel(uint march, SCARP_INOUT(ScarpVoxelWalk) walk, SCARP_INOUT(int) turns) {
  uint travel = march == kScarpVoxelSpheres ? scarp_travel_per_voxel(walk.speed) : 0u;
  bool solid = false;
  bool inside = true;
  while (inside && turns > 0) {
    SCARP_COUNT(walk);
    if (march == kScarpVoxelPlanes) {
      inside = scarp_planes_turn(walk, solid);
    } else if (march == kScarpVoxelSpheres) {
      inside = scarp_spheres_turn(walk, travel, solid);
    } else if (march == kScarpVoxelBricks) {
      inside = scarp_bricks_turn(walk, solid);
    } else {
      inside = scarp_cubes_turn(walk, solid);
    }
    if (!solid) --turns;
  }
  return solid;
}

SCARP_GLSL_END

#endif
