// SPDX-License-Identifier: MIT
// Voxel marches for a batch of rays, one invocation per ray.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define SCARP_INT64

#include "scarp/march/voxel/voxel_objects.glsl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < batch.count) scarp_ask_voxels(i);
}
