// SPDX-License-Identifier: MIT
// `naive`, `fixed-step`, `relaxed` or `lipschitz` for a batch of rays, one invocation per ray. Rays below the ground
// are left to height_marches_second.comp.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/march/height/ray_batch.glsl.h"
// The march reads its ground through the batch.
#include "scarp/march/height/height_marches_lean.glsl.h"
#include "scarp/march/height/max_mip.glsl.h"

// Ray i, for shaders specialised for this kind of ground.
ScarpRay known_ray(uint i) {
  ScarpRay ray = batch_ray(i);
  if (batch_ground != kBatchAnyGround && (batch_ground & kScarpStarts) == 0u) ray.flags &= ~kScarpOnSurface;
  return ray;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= batch.count) return;
  ScarpField field = batch_field(known_ray(i));
  ScarpSampling settings = batch.settings;
  settings.march = batch_march;
  settings.refinement = batch_refinement;
  ScarpHit hit = scarp_no_hit();
  ScarpStretch at = scarp_stretch_begin(field, known_ray(i), settings);
  for (;;) {
    // The ray is read again for each stretch, to free registers for the loop. The term added to i is 0, which compilers
    // cannot know; otherwise they would keep the ray.
    ScarpRay ray = known_ray(i + (uint(at.stretches) >> 30));
    if (!scarp_stretch_on(field, ray, settings, batch_any, at, hit)) continue;
    // In the loop, for lavapipe: vk/loop_turns.glsl.h.
    batch_answer(i, hit);
    if (hit.status == kScarpDoubtful) batch_mark();
    break;
  }
}
