// SPDX-License-Identifier: MIT
// `fixed-step` on a batch of rays, one invocation per ray.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/march/ray_batch.glsl.h"
// The march asks the batch for its ground.
#include "scarp/march/fixed_step.glsl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= batch.count) return;
  ScarpRay ray = BatchRays(batch.rays).rays[i];
  batch_answer(i, scarp_fixed_step(open_ground(batch.ground), ray,
                                   ScarpFixedStep(batch.step, batch.interpolate, batch.max_steps)));
}
