// SPDX-License-Identifier: MIT
// `lipschitz` for shaders: the march of lipschitz.h in single precision. Guarantee: conservative, as there, but for
// rounding (doc/dev/numerics.md, "Single precision"); over functions rounding is counted.
//
// Text of C++ and of GLSL, GLSL ES 3.0 included.
#ifndef SCARP_MARCH_LIPSCHITZ_GLSL_H
#define SCARP_MARCH_LIPSCHITZ_GLSL_H

#include "scarp/march/sampling.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Makes settings; see LipschitzSettings. `shrink` is at most 1 / sqrt(1 + c^2), c the field's slope bound.
SCARP_FN ScarpSampling scarp_lipschitz(float shrink, float tolerance, int max_steps) {
  return scarp_sampling(kScarpLipschitz, shrink, 0.0f, tolerance, max_steps, kScarpRefineNone);
}

/// Returns the status of the point at state.s, over ground if `valid`; or kScarpMiss, and moves to the next: no further
/// than `until`, and over a hole there.
SCARP_FN int scarp_lipschitz_turn(ScarpWay way, ScarpSampling settings, bool valid, float clearance, float until,
                                  SCARP_INOUT(ScarpMarchState) state) {
  int status = kScarpMiss;
  float next = until;
  if (valid && clearance < -way.rounding) {
    // There from the start, or out of a hole.
    bool first = state.steps == 0;
    bool from_outside = state.s + way.travelled > 0.0f;
    status = way.from_surface && first   ? kScarpHit
             : way.solid && from_outside ? kScarpWall
             : first                     ? kScarpBelow
                                         : kScarpExhausted;
  } else if (valid) {
    float free = (clearance - way.rounding) * settings.factor * way.per_clearance;
    // Less by what the sum may round up. A step that is too short to advance is a hit.
    next = state.s + (free - 1.1920928955078125e-7f * (state.s + free));
    if (free <= settings.tolerance * (state.s + way.travelled) || !(next > state.s)) status = kScarpHit;
    next = min(next, until);
  }
  // Its hits are not refined.
  if (status == kScarpMiss) scarp_step_to(next, false, clearance, state);
  return status;
}

SCARP_GLSL_END

#endif
