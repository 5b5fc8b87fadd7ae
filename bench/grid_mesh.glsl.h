// SPDX-License-Identifier: MIT
// Shared by grid_mesh.vert and gpu_raster.cpp.
#ifndef BENCH_GRID_MESH_GLSL_H
#define BENCH_GRID_MESH_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// Cells along the side of a patch. Each patch is an instance, so one small index list serves the whole grid.
const uint kGridPatch = 64u;

struct GridMeshPush {
  Address ground;
  uint patches;  // along a row of patches
  float near;    // depth 1, in cells
  ivec2 eye_cell;
  float eye_sample;
  // Clip coordinates x, y and w of a node: (column - eye's, row - eye's, sample - eye's, 1) times these.
  vec4 x;
  vec4 y;
  vec4 w;
};

SCARP_GLSL_END

#endif
