// SPDX-License-Identifier: MIT
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "test/vk/corners.glsl.h"

layout(push_constant, scalar) uniform Push { CornersPush push; };
layout(location = 0) out vec4 colour;

void main() { colour = push.colour; }
