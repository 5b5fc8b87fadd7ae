// SPDX-License-Identifier: MIT
// Writes the shader's view of each cell: its four heights, then 0 for a hole and 1 for any other cell.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/accel/ground_buffers.glsl.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Heights { float heights[]; };
layout(push_constant, scalar) uniform Push {
  Address ground;
  Address heights;
};

void main() {
  uvec2 cell = gl_WorkGroupID.xy;
  Ground field = Ground(ground);
  vec4 corners;
  bool whole = ground_cell(field, cell.x, cell.y, corners);
  uint at = 5u * (cell.y * field.is.cell_cols + cell.x);
  for (uint i = 0u; i < 4u; ++i) Heights(heights).heights[at + i] = corners[i];
  Heights(heights).heights[at + 4u] = whole ? 1.0 : 0.0;
}
