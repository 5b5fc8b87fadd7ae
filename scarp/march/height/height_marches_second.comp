// SPDX-License-Identifier: MIT
// `naive`, `fixed-step`, `relaxed` or `lipschitz` for the rays of a batch that height_marches.comp left, one invocation
// per ray.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/march/height/ray_batch.glsl.h"
// The march reads its ground through the batch.
#include "scarp/march/height/batch_states.glsl.h"
#include "scarp/march/height/height_marches.glsl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (!batch_asks(i)) return;
  ScarpRay ray = batch_ray(i);
  ScarpField field = batch_field(ray);
  ScarpSampling settings = batch.settings;
  settings.march = batch_march;
  ScarpHit hit = scarp_no_hit();
  ScarpMarchState state = scarp_sampled_begin(field, ray, settings);
  if (batch.resume == kBatchResume) {
    hit = BatchMarches(batch.states).of[i].hit;
    state = BatchMarches(batch.states).of[i].state;
  }
  if (scarp_sampled_on(field, ray, settings, batch.turns, state, hit)) {
    batch_answer(i, hit);
    return;
  }
  BatchMarches(batch.states).of[i] = BatchMarch(hit, state);
  batch_interrupt(i);
}
