// SPDX-License-Identifier: MIT
// Voxel marches by number. Text of C++ and of GLSL, GLSL ES 3.0 included.
#ifndef SCARP_ACCEL_VOXEL_MARKS_GLSL_H
#define SCARP_ACCEL_VOXEL_MARKS_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// They determine the marks of a grid, its accelerator.
const uint kScarpVoxelPlanes = 0u;
const uint kScarpVoxelSpheres = 1u;
const uint kScarpVoxelCubes = 2u;
const uint kScarpVoxelOctants = 3u;
const uint kScarpVoxelBricks = 4u;
const uint kScarpVoxelMarches = 5u;  ///< their number

SCARP_GLSL_END

#endif
