// SPDX-License-Identifier: MIT
// Shared by voxel_triangles.vert, .frag and .cpp.
#ifndef BENCH_VOXEL_TRIANGLES_GLSL_H
#define BENCH_VOXEL_TRIANGLES_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

struct VoxelTrianglesPush {
  Address faces;    ///< words: voxel, 8 bits for each of x, y, z, and the face
  Address objects;  ///< origin of each object, minus the eye
  float side;       ///< side of a voxel
  float near;       ///< depth 1; without perspective: depth 0
  // Clip coordinates x, y and w of a place less the eye: dot of these and (place, 1).
  vec4 x;
  vec4 y;
  vec4 w;
  vec3 forward;
  uint parallel;
};

SCARP_GLSL_END

#endif
