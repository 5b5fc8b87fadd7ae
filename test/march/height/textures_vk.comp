// SPDX-License-Identifier: MIT
// The marches over textures, on a batch of rays.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "test/march/height/textures_vk.glsl.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const int march = kTexturesMaxMip;
layout(constant_id = 1) const bool any = false;
layout(constant_id = 2) const uint sampled = kScarpNaive;
layout(binding = 0) uniform sampler2D scarp_heights;
layout(binding = 1) uniform sampler2D scarp_bounds;
layout(push_constant, scalar) uniform Push { TexturesPush push; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Rays { ScarpRay rays[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Hits { ScarpHit hits[]; };
#define scarp_nodata push.nodata

#include "scarp/march/height/textures.glsl.h"
// The marches read the textures.
#include "scarp/march/height/height_marches.glsl.h"
#include "scarp/march/height/max_mip.glsl.h"

ScarpHit answer(ScarpRay ray) {
  ScarpSampling settings = push.settings;
  settings.march = sampled;
  return march == kTexturesMaxMip ? scarp_max_mip(push.field, ray, any) : scarp_sampled(push.field, ray, settings);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < push.count) Hits(push.hits).hits[i] = answer(Rays(push.rays).rays[i]);
}
