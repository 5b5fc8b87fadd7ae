// SPDX-License-Identifier: MIT
// `max-mip` for the rays of a batch that max_mip.comp left, one invocation per ray.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/march/height/ray_batch.glsl.h"
// The march reads its ground through the batch.
#include "scarp/march/height/batch_states.glsl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (!batch_asks(i)) return;
  ScarpRay ray = batch_ray(i);
  ScarpField field = batch_field(ray);
  ScarpHit hit = scarp_no_hit();
  ScarpWalk walk;
  bool done = false;
  if (batch.resume != kBatchResume) {
    // The host clips rays to the highest sample.
    done = !scarp_begin_walk_at(field, scarp_own_start(ray), ray, walk, hit);
  } else {
    hit = BatchWalks(batch.states).of[i].hit;
    walk = BatchWalks(batch.states).of[i].walk;
    ray.z = BatchWalks(batch.states).of[i].z;
    ray.z_low = BatchWalks(batch.states).of[i].z_low;
  }
  if (!done) done = scarp_go_on(field, ray, batch_any, batch.turns, walk, hit);
  if (done) {
    batch_answer(i, hit);
    return;
  }
  BatchWalks(batch.states).of[i] = BatchWalk(hit, walk, ray.z, ray.z_low);
  batch_interrupt(i);
}
