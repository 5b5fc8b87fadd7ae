// SPDX-License-Identifier: MIT
// Calls naive, fixed-step, relaxed or lipschitz by ScarpSampling::march. If that is a constant, compilers omit the
// others.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0.
#ifndef SCARP_MARCH_SAMPLING_SAMPLING_MARCHES_GLSL_H
#define SCARP_MARCH_SAMPLING_SAMPLING_MARCHES_GLSL_H

#include "scarp/march/sampling/fixed_step.glsl.h"
#include "scarp/march/sampling/lipschitz.glsl.h"
#include "scarp/march/sampling/naive.glsl.h"
#include "scarp/march/sampling/relaxed.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// The state before the first point.
SCARP_FN ScarpMarchState scarp_sampling_begin(ScarpWay way, ScarpSampling settings) {
  if (settings.march == kScarpFixedStep) return scarp_fixed_step_begin(way, settings);
  ScarpMarchState state;
  state.s = 0.0f;
  if (way.from_surface) state.s = settings.march == kScarpNaive ? scarp_naive_least(way, settings) : way.blind;
  state.before = 0.0f;
  state.h_before = 0.0f;
  state.steps = 0;
  state.phase = 0u;
  return state;
}

/// Returns the status of the point at state.s, over ground if `valid`; or kScarpMiss, and moves to the next. `until` is
/// for lipschitz.
SCARP_FN int scarp_sampling_turn(ScarpWay way, ScarpSampling settings, bool valid, float clearance, float until,
                                 SCARP_INOUT(ScarpMarchState) state) {
  int status;
  if (settings.march == kScarpNaive)
    status = scarp_naive_turn(way, settings, valid, clearance, state);
  else if (settings.march == kScarpFixedStep)
    status = scarp_fixed_step_turn(way, settings, valid, clearance, state);
  else if (settings.march == kScarpRelaxed)
    status = scarp_relaxed_turn(way, settings, valid, clearance, state);
  else
    status = scarp_lipschitz_turn(way, settings, valid, clearance, until, state);
  return status;
}

/// The time that an exhausted march reports.
SCARP_FN float scarp_sampling_reached(ScarpSampling settings, ScarpMarchState state) {
  return settings.march == kScarpFixedStep ? state.before : state.s;
}

/// The status of a ray without a hit.
SCARP_FN int scarp_sampling_missed(ScarpMarchState state) {
  return (state.phase & kScarpBeganBelow) != 0u ? kScarpBelow : kScarpMiss;
}

/// Whether to refine a hit at state.s, between state.before and state.s.
SCARP_FN bool scarp_sampling_refines(ScarpSampling settings, ScarpMarchState state) {
  return settings.refinement != kScarpRefineNone && (state.phase & kScarpKnown) != 0u;
}
/// Whether a point between them is a hit, too: kScarpRefineBisect halves by this test.
SCARP_FN bool scarp_sampling_stops(ScarpWay way, ScarpSampling settings, float s, float clearance) {
  bool stops;
  if (settings.march == kScarpFixedStep)
    stops = scarp_fixed_step_stops(clearance);
  else if (settings.march == kScarpNaive)
    stops = scarp_naive_stops(way, settings, s, clearance);
  else
    stops = scarp_relaxed_stops(way, settings, s, clearance);
  return stops;
}
/// Where a straight line through the clearances at state.before and state.s reaches the limit of the test.
SCARP_FN float scarp_sampling_secant(ScarpWay way, ScarpSampling settings, float clearance, ScarpMarchState state) {
  if (state.h_before == clearance) return state.s;
  float limit = 0.0f;
  if (settings.march != kScarpFixedStep) limit = scarp_hit_limit(way, settings, state.s) / way.per_clearance;
  // `relaxed` may come from above or, having overshot, from below.
  if (settings.march == kScarpRelaxed && state.h_before < 0.0f) limit = -limit;
  float share = clamp((state.h_before - limit) / (state.h_before - clearance), 0.0f, 1.0f);
  return state.before + (state.s - state.before) * share;
}

SCARP_GLSL_END

#endif
