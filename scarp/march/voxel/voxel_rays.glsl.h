// SPDX-License-Identifier: MIT
// Rays and hits of voxel objects, shared by shaders and C++ (voxel_queries_vk.h, voxel_pictures_vk.h).
#ifndef SCARP_MARCH_VOXEL_RAYS_GLSL_H
#define SCARP_MARCH_VOXEL_RAYS_GLSL_H

#include "scarp/accel/voxel_buffers.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// A ray in world space, with numbers in the usual range (voxel_queries_vk.cpp).
struct ScarpVoxelRay {
  dvec3 origin;
  dvec3 direction;
  double t_min;
  double t_max;
  uint part;    ///< the object whose voxel it starts beside; kScarpNoPart: none
  ivec3 start;  ///< that voxel
  uint frame;   ///< Ray::frame
  uint room;    ///< Ray::room
};
const uint kScarpNoPart = 0xffffffffu;

const uint kScarpVoxelMiss = 0u;
const uint kScarpVoxelHit = 1u;
const uint kScarpVoxelUnfinished = 2u;  ///< it exceeded the iteration limit
const uint kScarpVoxelTied = 3u;        ///< only when drawn (voxel_proxies.glsl.h): another object may be as near

/// The result; for misses only status and steps are defined.
struct ScarpVoxelHit {
  double t;
  ivec3 voxel;
  uint part;
  uint face;
  uint status;
  uint steps;
  uint entry;
};

#ifndef __cplusplus

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer VoxelRays { ScarpVoxelRay rays[]; };
// The same, read again rather than kept.
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly volatile buffer VoxelRaysAgain {
  ScarpVoxelRay rays[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) writeonly buffer VoxelHits { ScarpVoxelHit hits[]; };

#endif

SCARP_GLSL_END

#endif
