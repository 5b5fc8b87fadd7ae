// SPDX-License-Identifier: MIT
// `naive`, `fixed-step`, `relaxed` or `lipschitz` over a terrain function on a batch of rays, one invocation per ray.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/march/function/function_batch.glsl.h"
// The march reads its instructions through the batch.
#include "scarp/march/function/function_marches.glsl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= batch.count) return;
  ScarpFunctionRay ray = FunctionRays(batch.rays).rays[i];
  ScarpSampling settings = batch.settings;
  settings.march = batch_choice;
  FunctionHits(batch.hits).hits[i] =
      scarp_function_march(ScarpProgram(batch.instructions, batch.result), ray, settings, batch.run_steps);
}
