// SPDX-License-Identifier: MIT
// `max-mip` for a batch of rays, one invocation per ray. Rays that floats cannot decide are left to max_mip_exact.comp.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/march/height/ray_batch.glsl.h"
// The march reads its ground through the batch.
#include "scarp/march/height/max_mip_lean.glsl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= batch.count) return;
  ScarpField field = batch_field(batch_ray(i));
  Ground ground = Ground(batch.ground);
  ScarpLeanCodes codes = ScarpLeanCodes(ground.is.code_per_step, ground.is.code_over, ground.is.spread);
  ScarpLean at = scarp_lean_begin();
  for (;;) {
    ScarpHit hit;
    // The ray is read again for each frame, to free registers for the walk.
    if (!scarp_lean_on(field, codes, batch_ray(i), batch_any, at, hit)) continue;
    // Written inside the loop: lavapipe (Mesa 22.3) gives a lane that has left the loop the later results of others.
    batch_answer(i, hit);
    if (hit.status == kScarpDoubtful) batch_mark();
    break;
  }
}
