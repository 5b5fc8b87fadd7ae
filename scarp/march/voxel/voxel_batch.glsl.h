// SPDX-License-Identifier: MIT
// A batch of rays over voxel objects on a device: shared by voxel_marches.comp and the C++ code that dispatches it
// (voxel_queries_vk.h).
//
//   VoxelBatch ──objects──▶ ScarpVoxelObjects: hierarchy, objects, grids
//       │  └───────rays──▶ ScarpVoxelRay ...      one invocation each
//       └──────────hits──▶ ScarpVoxelHit ...      the answers, in the same order
#ifndef SCARP_MARCH_VOXEL_BATCH_GLSL_H
#define SCARP_MARCH_VOXEL_BATCH_GLSL_H

#include "scarp/accel/voxel_buffers.glsl.h"
#include "scarp/march/voxel/voxel_rays.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// Specialisation constants: threads per workgroup; any hit or closest hit; the march, or kScarpVoxelMarches if grids
// use several; levels of the hierarchy; whether 64-bit integers are two words; whether hits have their entry.

/// Numbers of a ray that stay in memory during marches.
struct ScarpVoxelScratch {
  dvec3 given;    ///< its direction in the grid of the current object
  dvec3 inverse;  ///< 1 / given
  dvec3 origin;   ///< in that grid
  double t_per_s;
  double t;     ///< where it enters the object's box
  double t_in;  ///< where it enters the outer box
  uvec3 speed;
  uint back;
  uint entered;  ///< face of the object's box
  float longest;
};

/// Push constants.
struct VoxelBatch {
  Address objects;
  Address rays;
  Address hits;
  Address scratch;  ///< a ScarpVoxelScratch per ray
  uint count;
  int turns;  ///< steps and nodes of a ray
};

#ifndef __cplusplus

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint batch_any = 0;
layout(constant_id = 2) const uint batch_march = kScarpVoxelMarches;
layout(constant_id = 3) const uint batch_levels = 32;
layout(constant_id = 4) const uint batch_words = 0;
layout(constant_id = 5) const uint batch_entries = 0;

layout(push_constant, scalar) uniform Push { VoxelBatch batch; };

// The grid that is marched.
ScarpVoxelGrid voxel_grid;

bool scarp_voxel_words() { return batch_words != 0u; }
uvec2 scarp_voxel_mask(ivec3 brick) { return voxel_mask(voxel_grid, brick); }
uvec2 scarp_voxel_sector(ivec3 sector) { return voxel_sector(voxel_grid, sector); }
uint scarp_voxel_byte(ivec3 voxel, uint octant) { return voxel_byte(voxel_grid, voxel, octant); }

#endif

SCARP_GLSL_END

#endif
