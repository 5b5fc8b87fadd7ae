// SPDX-License-Identifier: MIT
// Where marches of a batch (ray_batch.glsl.h) stand that have been interrupted, one struct per ray. C++, for the
// structs, and GLSL, which has defined what cell_surface.glsl.h and max_mip.glsl.h ask for before it includes this.
#ifndef SCARP_MARCH_BATCH_STATES_GLSL_H
#define SCARP_MARCH_BATCH_STATES_GLSL_H

#ifdef __cplusplus
#include "scarp/march/height/march_host.h"
#endif
#include "scarp/march/fixed_step.glsl.h"
#include "scarp/march/height/max_mip.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Of `max-mip`.
struct BatchWalk {
  ScarpHit hit;
  ScarpWalk walk;
  float z;  ///< of the ray, which a walk from the surface begins with
  float z_low;
};

/// Of `fixed-step`.
struct BatchSteps {
  ScarpHit hit;
  ScarpSteps steps;
};

/// Of `naive`, `relaxed` and `lipschitz`: the time of the next point.
struct BatchTime {
  ScarpHit hit;
  float s;
};

#ifndef __cplusplus

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BatchWalks { BatchWalk of[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BatchAllSteps { BatchSteps of[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BatchTimes { BatchTime of[]; };

// The march of ray i, which stands at time s: answered, or to go on in the next run.
void batch_answer_or_keep(bool done, uint i, ScarpHit hit, float s) {
  if (done) {
    batch_answer(i, hit);
    return;
  }
  BatchTimes(batch.states).of[i] = BatchTime(hit, s);
  batch_interrupt(i);
}
// Where it has been left, if it has.
void batch_go_on(uint i, inout ScarpHit hit, inout float s) {
  if (batch.resume == 0u) return;
  hit = BatchTimes(batch.states).of[i].hit;
  s = BatchTimes(batch.states).of[i].s;
}

#endif

SCARP_GLSL_END

#endif
