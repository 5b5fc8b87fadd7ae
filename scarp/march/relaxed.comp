// SPDX-License-Identifier: MIT
// `relaxed` on a batch of rays, one invocation per ray.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/march/ray_batch.glsl.h"
// The march asks the batch for its ground.
#include "scarp/march/relaxed.glsl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= batch.count) return;
  ScarpRay ray = BatchRays(batch.rays).rays[i];
  batch_answer(
      i, scarp_relaxed(open_ground(batch.ground), ray, ScarpRelaxed(batch.step, batch.tolerance, batch.max_steps)));
}
