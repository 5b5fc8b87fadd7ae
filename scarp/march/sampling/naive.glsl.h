// SPDX-License-Identifier: MIT
// `naive` for shaders: the march of naive.h in single precision. Guarantee: approximate, as there.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0.
#ifndef SCARP_MARCH_SAMPLING_NAIVE_GLSL_H
#define SCARP_MARCH_SAMPLING_NAIVE_GLSL_H

#include "scarp/march/sampling/sampling.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Makes settings; see NaiveSettings.
SCARP_FN ScarpSampling scarp_naive(float step_factor, float min_step, float tolerance, int max_steps) {
  return scarp_sampling(kScarpNaive, step_factor, min_step, tolerance, max_steps, kScarpRefineNone);
}

/// The minimum step, a time; also the first step off the surface.
SCARP_FN float scarp_naive_least(ScarpWay way, ScarpSampling settings) {
  return max(settings.least * (way.travelled + way.exit), scarp_start_margin(way, settings));
}

/// Whether a point at time s is a hit: every point below the ground is, unless the ray has entered below it.
SCARP_FN bool scarp_naive_stops(ScarpWay way, ScarpSampling settings, float s, float clearance) {
  return clearance * way.per_clearance < scarp_hit_limit(way, settings, s);
}

/// Returns kScarpHit or kScarpWall for the point at state.s, over ground if `valid`; or kScarpMiss, and moves to the
/// next.
SCARP_FN int scarp_naive_turn(ScarpWay way, ScarpSampling settings, bool valid, float clearance,
                              SCARP_INOUT(ScarpMarchState) state) {
  int status = kScarpMiss;
  bool stops = valid && scarp_naive_stops(way, settings, state.s, clearance);
  bool comes_in = scarp_comes_in_under(way, valid, clearance, state);
  scarp_mark_under(comes_in, valid, clearance, !stops, state);
  if (comes_in && way.solid) {
    status = kScarpWall;
  } else if (stops && (state.phase & kScarpUnder) == 0u) {
    status = kScarpHit;
  } else {
    // Over a hole only the minimum step is known.
    float by_height = valid ? settings.factor * abs(clearance * way.per_clearance) : 0.0f;
    scarp_step_to(state.s + max(by_height, scarp_naive_least(way, settings)), valid, clearance, state);
  }
  return status;
}

SCARP_GLSL_END

#endif
