// SPDX-License-Identifier: MIT
// Builds one level of the quads (ground_buffers.glsl.h): for each block the maximum codes of its 2 x 2 children, the
// cells themselves on level 1. Each invocation writes one quad.
//
// A hole gets the code of its highest valid corner: a ray above it is above the ground where it leaves the hole.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/accel/ground_buffers.glsl.h"
#include "scarp/accel/max_pyramid.glsl.h"
#include "scarp/accel/max_quads.glsl.h"

layout(local_size_x = kPyramidGroupCols, local_size_y = kPyramidGroupRows) in;
layout(push_constant, scalar) uniform Push { QuadsPush push; };
layout(buffer_reference, scalar, buffer_reference_align = 8) writeonly buffer Quads { uvec2 of[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Spread { uint bits; };

// Returns the maximum code of a cell, 0 outside the field. Raises `relief` to its height difference.
uint cell_code(Ground ground, uvec2 at, inout float relief) {
  if (at.x >= ground.is.cell_cols || at.y >= ground.is.cell_rows) return 0u;
  uint east = ground_east(ground, at.x), south = ground_south(ground, at.y);
  uvec4 bits = uvec4(ground_sample_bits(ground, at.x, at.y), ground_sample_bits(ground, east, at.y),
                     ground_sample_bits(ground, at.x, south), ground_sample_bits(ground, east, south));
  bool hole = false;
  float highest = ground.is.min_sample, lowest = ground.is.max_sample;
  for (int corner = 0; corner < 4; ++corner) {
    if (ground_is_nodata(ground, bits[corner])) {
      hole = true;
      continue;
    }
    float height = ground_sample_value(ground, bits[corner]);
    highest = max(highest, height);
    lowest = min(lowest, height);
  }
  if (!hole) relief = max(relief, (highest - lowest) * kReliefRounding);
  return scarp_code_above(highest, ground.is.code_base, ground.is.code_base_low, ground.is.code_per_step);
}

uint highest_of(uvec2 quad) { return max(max(quad.x & 0xffffu, quad.x >> 16), max(quad.y & 0xffffu, quad.y >> 16)); }

void main() {
  uvec2 at = uvec2(push.col_begin, push.row_begin) + gl_GlobalInvocationID.xy;
  if (at.x >= push.col_end || at.y >= push.row_end) return;
  Ground ground = Ground(push.ground);
  uint cols = ground.is.quad_cols, rows = ground.is.quad_rows, stride = ground.is.quad_stride;
  uvec4 codes;
  float relief = 0.0;
  for (uint child = 0u; child < 4u; ++child) {
    uvec2 place = 2u * at + uvec2(child & 1u, child >> 1);
    if (push.level == 1u) {
      codes[child] = cell_code(ground, place, relief);
    } else {
      GroundLevel finer = ground.is.levels[push.level - 2u];
      bool inside = place.x < finer.cols && place.y < finer.rows;
      uvec2 quad = uvec2(0u);
      if (inside)
        quad = GroundQuads(ground.is.quads).of[ground_quad(cols, rows, stride, push.level - 1u, place.x, place.y)];
      codes[child] = highest_of(quad);
    }
  }
  Quads(ground.is.quads).of[ground_quad(cols, rows, stride, push.level, at.x, at.y)] =
      uvec2(codes.x | codes.y << 16, codes.z | codes.w << 16);
  // Floats of one sign are in the order of their bits.
  if (relief > 0.0) atomicMax(Spread(push.spread).bits, floatBitsToUint(kGroundSpread * relief));
}
