// SPDX-License-Identifier: MIT
// `lipschitz-local` over a terrain function for a batch of rays, one invocation per ray.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/march/function/function_batch.glsl.h"
// The march reads its instructions through the batch.
#include "scarp/march/function/lipschitz_local.glsl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= batch.count) return;
  ScarpFunctionRay ray = FunctionRays(batch.rays).rays[i];
  FunctionHits(batch.hits).hits[i] = scarp_lipschitz_local(
      ScarpProgram(batch.instructions, batch.result), ray,
      ScarpLipschitzLocal(batch.settings.tolerance, batch.settings.max_steps, batch.run_steps), batch_choice != 0u);
}
