// SPDX-License-Identifier: MIT
// max-mip over textures, on a batch of rays.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "test/march/textures_vk.glsl.h"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2D scarp_heights;
layout(binding = 1) uniform sampler2D scarp_bounds;
layout(push_constant, scalar) uniform Push { TexturesPush push; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Rays { ScarpRay rays[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Hits { ScarpHit hits[]; };
#define scarp_nodata push.nodata

#include "scarp/march/textures.glsl.h"
// The march asks the textures.
#include "scarp/march/max_mip.glsl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < push.count) Hits(push.hits).hits[i] = scarp_max_mip(push.field, Rays(push.rays).rays[i], false);
}
