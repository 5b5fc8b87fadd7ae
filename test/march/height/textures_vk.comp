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
layout(binding = 0) uniform sampler2D scarp_heights;
layout(binding = 1) uniform sampler2D scarp_bounds;
layout(push_constant, scalar) uniform Push { TexturesPush push; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Rays { ScarpRay rays[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Hits { ScarpHit hits[]; };
#define scarp_nodata push.nodata

#include "scarp/march/height/textures.glsl.h"
// The marches ask the textures.
#include "scarp/march/fixed_step.glsl.h"
#include "scarp/march/height/max_mip.glsl.h"
#include "scarp/march/lipschitz.glsl.h"
#include "scarp/march/naive.glsl.h"
#include "scarp/march/relaxed.glsl.h"

ScarpHit answer(ScarpRay ray) {
  if (march == kTexturesNaive)
    return scarp_naive(push.field, ray, ScarpNaive(push.step, push.min_step, push.tolerance, push.max_steps));
  if (march == kTexturesFixedStep)
    return scarp_fixed_step(push.field, ray, ScarpFixedStep(push.step, push.interpolate, push.max_steps));
  if (march == kTexturesRelaxed)
    return scarp_relaxed(push.field, ray, ScarpRelaxed(push.step, push.tolerance, push.max_steps));
  if (march == kTexturesLipschitz)
    return scarp_lipschitz(push.field, ray, ScarpLipschitz(push.step, push.tolerance, push.max_steps));
  return scarp_max_mip(push.field, ray, any);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < push.count) Hits(push.hits).hits[i] = answer(Rays(push.rays).rays[i]);
}
