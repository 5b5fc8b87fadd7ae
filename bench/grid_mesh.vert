// SPDX-License-Identifier: MIT
// A node of the grid, fetched from the samples that the marches read. Patches beyond the border collapse to lines
// there.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "bench/grid_mesh.glsl.h"
#include "scarp/accel/ground_buffers.glsl.h"

layout(push_constant, scalar) uniform Push { GridMeshPush push; };

void main() {
  Ground ground = Ground(push.ground);
  uint side = kGridPatch + 1u, index = uint(gl_VertexIndex), patch_index = uint(gl_InstanceIndex);
  uint col = min(patch_index % push.patches * kGridPatch + index % side, ground.is.cols - 1u);
  uint row = min(patch_index / push.patches * kGridPatch + index / side, ground.is.rows - 1u);
  float height = ground_sample_value(ground, ground_sample_bits(ground, col, row));
  vec4 node = vec4(vec2(ivec2(col, row) - push.eye_cell), height - push.eye_sample, 1.0);
  gl_Position = vec4(dot(push.x, node), dot(push.y, node), push.near, dot(push.w, node));
}
