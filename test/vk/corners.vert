// SPDX-License-Identifier: MIT
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "test/vk/corners.glsl.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Corners { vec4 corners[]; };
layout(push_constant, scalar) uniform Push { CornersPush push; };

void main() {
  gl_Position = Corners(push.corners).corners[gl_VertexIndex];
  gl_Position.x += push.right * float(gl_InstanceIndex);
}
