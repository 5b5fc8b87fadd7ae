// SPDX-License-Identifier: MIT
// `lipschitz` on a batch of rays, one invocation per ray.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/march/height/ray_batch.glsl.h"
// The march asks the batch for its ground.
#include "scarp/march/height/batch_states.glsl.h"
#include "scarp/march/lipschitz.glsl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (!batch_asks(i)) return;
  ScarpField field = open_ground(batch.ground);
  ScarpRay ray = BatchRays(batch.rays).rays[i];
  ScarpLipschitz settings = ScarpLipschitz(batch.step, batch.tolerance, batch.max_steps);
  ScarpHit hit = scarp_no_hit();
  float s = scarp_lipschitz_begin(ray);
  batch_go_on(i, hit, s);
  bool done = scarp_lipschitz_on(field, ray, settings, batch.turns, s, hit);
  batch_answer_or_keep(done, i, hit, s);
}
