// SPDX-License-Identifier: MIT
// Numbers of the voxel marches. Valid C++ and GLSL, including GLSL ES 3.0.
#ifndef SCARP_ACCEL_VOXEL_MARKS_GLSL_H
#define SCARP_ACCEL_VOXEL_MARKS_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// The march determines the marks of a grid: its accelerator.
const uint kScarpVoxelPlanes = 0u;
const uint kScarpVoxelSpheres = 1u;
const uint kScarpVoxelCubes = 2u;
const uint kScarpVoxelOctants = 3u;
const uint kScarpVoxelBricks = 4u;
const uint kScarpVoxelMarches = 5u;  ///< the number of marches

SCARP_GLSL_END

#endif
