// SPDX-License-Identifier: MIT
// to[i] = bonus + twice(from[i]).
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "test/vk/twice.glsl.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint bonus = 0u;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Words { uint words[]; };
layout(push_constant, scalar) uniform Push { TwicePush push; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  uint result = 0u;
  for (uint round = 0u; round < push.rounds; ++round) result = bonus + twice(Words(push.from).words[i] + result % 1u);
  Words(push.to).words[i] = result;
}
