// SPDX-License-Identifier: MIT
// `relaxed` for shaders: the march of relaxed.h in single precision. Guarantee: approximate, as there.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0.
#ifndef SCARP_MARCH_SAMPLING_RELAXED_GLSL_H
#define SCARP_MARCH_SAMPLING_RELAXED_GLSL_H

#include "scarp/march/sampling/sampling.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Makes settings; see RelaxedSettings.
SCARP_FN ScarpSampling scarp_relaxed(float step_factor, float tolerance, int max_steps) {
  return scarp_sampling(kScarpRelaxed, step_factor, 0.0f, tolerance, max_steps, kScarpRefineNone);
}

/// Whether a point at time s is a hit: within the tolerance of the ground, above or below.
SCARP_FN bool scarp_relaxed_stops(ScarpWay way, ScarpSampling settings, float s, float clearance) {
  return abs(clearance * way.per_clearance) < scarp_hit_limit(way, settings, s);
}

/// Returns the status of the point at state.s, over ground if `valid`; or kScarpMiss, and moves to the next, back from
/// below the ground unless the ray has entered there.
SCARP_FN int scarp_relaxed_turn(ScarpWay way, ScarpSampling settings, bool valid, float clearance,
                                SCARP_INOUT(ScarpMarchState) state) {
  int status = kScarpMiss;
  float next = state.s + way.blind;
  bool comes_in = scarp_comes_in_under(way, valid, clearance, state);
  float above = clearance * way.per_clearance;
  scarp_mark_under(comes_in, valid, clearance, above >= scarp_hit_limit(way, settings, state.s), state);
  if (comes_in && way.solid)
    status = kScarpWall;
  else if (valid && (state.phase & kScarpUnder) != 0u)
    next = state.s + max(settings.factor * abs(above), scarp_least_under(way, state.s));
  else if (valid && scarp_relaxed_stops(way, settings, state.s, clearance))
    status = kScarpHit;
  else if (valid && clearance < 0.0f && state.steps == 0)  // stepping back would leave the ray's range
    status = way.from_surface ? kScarpHit : kScarpBelow;
  else if (valid)
    next = max(state.s + settings.factor * above, 0.0f);
  if (status == kScarpMiss) scarp_step_to(next, valid, clearance, state);
  return status;
}

SCARP_GLSL_END

#endif
