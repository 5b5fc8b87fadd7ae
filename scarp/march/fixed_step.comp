// SPDX-License-Identifier: MIT
// `fixed-step` on a batch of rays, one invocation per ray.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/march/height/ray_batch.glsl.h"
// The march asks the batch for its ground.
#include "scarp/march/height/batch_states.glsl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (!batch_asks(i)) return;
  ScarpField field = open_ground(batch.ground);
  ScarpRay ray = BatchRays(batch.rays).rays[i];
  ScarpFixedStep settings = ScarpFixedStep(batch.step, batch.interpolate, batch.max_steps);
  ScarpHit hit = scarp_no_hit();
  ScarpSteps steps = scarp_first_step(ray);
  if (batch.resume != 0u) {
    hit = BatchAllSteps(batch.states).of[i].hit;
    steps = BatchAllSteps(batch.states).of[i].steps;
  }
  if (scarp_step_on(field, ray, settings, batch.turns, steps, hit)) {
    batch_answer(i, hit);
    return;
  }
  BatchAllSteps(batch.states).of[i] = BatchSteps(hit, steps);
  batch_interrupt(i);
}
