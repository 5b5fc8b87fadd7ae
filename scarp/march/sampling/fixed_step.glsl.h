// SPDX-License-Identifier: MIT
// `fixed-step` for shaders: the march of fixed_step.h in single precision. Guarantee: approximate, as there. Its points
// are those of the march in double.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0.
#ifndef SCARP_MARCH_SAMPLING_FIXED_STEP_GLSL_H
#define SCARP_MARCH_SAMPLING_FIXED_STEP_GLSL_H

#include "scarp/march/sampling/sampling.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Makes settings; see FixedStepSettings. The step is in cells, over functions in metres; kScarpRefineSecant puts a hit
/// between the last two points, kScarpRefineNone on the last.
SCARP_FN ScarpSampling scarp_fixed_step(float step, uint refinement, int max_steps) {
  return scarp_sampling(kScarpFixedStep, step, 0.0f, 0.0f, max_steps, refinement);
}

/// The time of point number state.steps; the last point is at way.last. Computed from the count, not accumulated, while
/// steps are equal.
SCARP_FN float scarp_fixed_step_time(ScarpWay way, ScarpSampling settings, ScarpMarchState state) {
  float s = float(state.steps) * way.stride;
  if (settings.least > 0.0f && state.steps > 0)
    s = state.before + max(way.stride, settings.least * (state.before + way.travelled));
  return min(s, way.last);
}

/// Starts at the first point, or at the second from the surface.
SCARP_FN ScarpMarchState scarp_fixed_step_begin(ScarpWay way, ScarpSampling settings) {
  ScarpMarchState state;
  state.before = 0.0f;
  state.h_before = 0.0f;
  state.steps = way.from_surface ? 1 : 0;
  state.phase = way.from_surface ? kScarpKnown | kScarpWasAbove : 0u;
  state.s = 0.0f;
  state.s = scarp_fixed_step_time(way, settings, state);
  return state;
}

/// Whether a point after one above the ground is a hit.
SCARP_FN bool scarp_fixed_step_stops(float clearance) { return clearance <= 0.0f; }

/// Returns the status of the point at state.s, over ground if `valid`; or kScarpMiss, and moves to the next.
SCARP_FN int scarp_fixed_step_turn(ScarpWay way, ScarpSampling settings, bool valid, float clearance,
                                   SCARP_INOUT(ScarpMarchState) state) {
  int status = kScarpMiss;
  bool known = (state.phase & kScarpKnown) != 0u;
  if (valid && (clearance > 0.0f || (way.from_surface && clearance == 0.0f))) {
    state.phase |= kScarpWasAbove;
  } else if (valid && known && (state.phase & kScarpWasAbove) != 0u) {
    status = kScarpHit;
    // From a point on the surface there is no interval to refine.
    if (!(state.h_before > 0.0f)) state.phase &= ~kScarpKnown;
  } else if (valid && !known && clearance == 0.0f) {
    status = kScarpHit;
  } else if (valid && !known && way.solid && (state.steps > 0 || way.from_outside)) {
    status = kScarpWall;
  } else if (valid) {
    if (state.steps == 0) state.phase |= kScarpBeganBelow;
    state.phase &= ~kScarpWasAbove;
  }
  if (status == kScarpMiss) {
    bool ends = !(state.s < way.last);
    scarp_step_to(state.s, valid, clearance, state);
    state.s = ends ? kScarpNever : scarp_fixed_step_time(way, settings, state);
  }
  return status;
}

SCARP_GLSL_END

#endif
