// SPDX-License-Identifier: MIT
// `sphere-trace` on a batch of rays, one invocation per ray.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/march/shape_batch.glsl.h"
// The march asks the batch for its instructions.
#include "scarp/march/sphere_trace.glsl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= batch.count) return;
  ScarpFunctionRay ray = ShapeRays(batch.rays).rays[i];
  ShapeHits(batch.hits).hits[i] =
      scarp_sphere_trace(batch.instructions, ray,
                         ScarpSphereTrace(batch.tolerance, batch.max_steps, batch.run_steps), batch_any != 0u);
}
