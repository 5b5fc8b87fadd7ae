// SPDX-License-Identifier: MIT
// Settings and rays of naive, fixed-step, relaxed and lipschitz in shaders.
//
// Each march is a *turn* (naive.glsl.h and so on): given the clearance at time state.s, it returns a hit or sets
// state.s to the next time. The loops are in height/height_marches.glsl.h and function/function_marches.glsl.h.
//
//   state.s ──▶ probe: clearance, or nothing over a hole ──▶ turn ──▶ hit, or the next state.s
//
// Functions called in each turn return only at their end: an early return becomes a loop of one turn, and some drivers
// limit the iterations of all loops (vk/loop_turns.glsl.h).
//
// Compiles as C++ and GLSL, including GLSL ES 3.0.
#ifndef SCARP_MARCH_SAMPLING_SAMPLING_GLSL_H
#define SCARP_MARCH_SAMPLING_SAMPLING_GLSL_H

#include "scarp/march/march_state.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// Values of ScarpSampling::march.
const uint kScarpNaive = 0u;
const uint kScarpFixedStep = 1u;
const uint kScarpRelaxed = 2u;
const uint kScarpLipschitz = 3u;

// The values of Refinement.
const uint kScarpRefineNone = 0u;
const uint kScarpRefineSecant = 1u;
const uint kScarpRefineBisect = 2u;

/// Settings of one march, as in MarchSettings.
struct ScarpSampling {
  uint march;       ///< kScarpNaive and so on
  float factor;     ///< naive, relaxed: step factor; lipschitz: shrink factor; fixed-step: step in cells or metres
  float least;      ///< naive: minimum step, as a fraction of the ray's length; fixed-step: fraction of the distance
                    ///< travelled
  float tolerance;  ///< distance off the ground that counts as a hit, per unit of distance; fixed-step ignores it
  float height;     ///< naive, relaxed: height in sample units or metres that is a hit at any distance
  int max_steps;    ///< maximum number of points, >= 1; then kScarpExhausted
  uint refinement;  ///< of the last interval, kScarpRefineNone and so on; lipschitz ignores it
  int halvings;     ///< for kScarpRefineBisect
  uint proven;      ///< lipschitz: 0 if steps of `factor` may pass through the ground; points below it are then hits
};

/// Makes settings with `height` and `halvings` 0 and `proven` 1.
SCARP_FN ScarpSampling scarp_sampling(uint march, float factor, float least, float tolerance, int max_steps,
                                      uint refinement) {
  ScarpSampling settings;
  settings.march = march;
  settings.factor = factor;
  settings.least = least;
  settings.tolerance = tolerance;
  settings.height = 0.0f;
  settings.max_steps = max_steps;
  settings.refinement = refinement;
  settings.halvings = 0;
  settings.proven = 1u;
  return settings;
}

/// A ray in the form that the marches use; all members are times, except as noted. Clearances are in the field's own
/// unit.
struct ScarpWay {
  float exit;           ///< when it leaves the field or its range ends: naive's minimum step is a fraction of it
  float last;           ///< of the last point, inclusive: exit, or earlier if nothing more can be hit
  float travelled;      ///< from the start of the ray's range to time 0
  float per_clearance;  ///< time in which the ray travels one unit of clearance
  float rounding;       ///< error bound of clearances, in their unit
  float blind;          ///< the first step off the surface, and a step over a hole
  float stride;         ///< of fixed-step
  bool from_surface;
  bool from_outside;  ///< enters through the border
  bool solid;         ///< the ground is solid
};

// Bits of ScarpMarchState::phase. `before` and `h_before` are the time and clearance of the previous point.
const uint kScarpKnown = 1u;       ///< the previous point was over ground
const uint kScarpWasAbove = 2u;    ///< the last point over ground was above it
const uint kScarpBeganBelow = 4u;  ///< the first one was below it
const uint kScarpUnder = 8u;       ///< the ray has entered below the ground, and has not emerged since

/// The height around the ground, as a time, within which rays of naive from the surface begin; 0 without a tolerance
/// for it. Rounding may be more.
SCARP_FN float scarp_start_margin(ScarpWay way, ScarpSampling settings) {
  bool counts = settings.march == kScarpNaive && way.from_surface && settings.height > 0.0f;
  return counts ? max(settings.height, way.rounding) * way.per_clearance : 0.0f;
}

/// The distance off the ground below which a point at time s is a hit of naive and relaxed, as a time.
SCARP_FN float scarp_hit_limit(ScarpWay way, ScarpSampling settings, float s) {
  float share = settings.tolerance * (s + way.travelled), margin = scarp_start_margin(way, settings);
  return margin > 0.0f ? share - margin : max(settings.height * way.per_clearance, share);
}

/// Returns whether the ray enters below the ground at the point at state.s, through the border or from a hole. Entering
/// there is not a hit: the ray continues, and hits where it later crosses the ground from above.
SCARP_FN bool scarp_comes_in_under(ScarpWay way, bool valid, float clearance, ScarpMarchState state) {
  bool unseen_before = (state.phase & kScarpKnown) == 0u && (state.steps > 0 || way.from_outside);
  return valid && clearance < -way.rounding && unseen_before;
}
/// Sets kScarpUnder at such a point. Clears it where the ray is `clear` of the ground, above it by more than the hit
/// tolerance, or descends again.
SCARP_FN void scarp_mark_under(bool comes_in, bool valid, float clearance, bool clear,
                               SCARP_INOUT(ScarpMarchState) state) {
  bool was_above = (state.phase & kScarpKnown) != 0u && state.h_before >= 0.0f;
  if (comes_in)
    state.phase |= kScarpUnder | (state.steps == 0 ? kScarpBeganBelow : 0u);
  else if (valid && (clear || (was_above && clearance < state.h_before)))
    state.phase &= ~kScarpUnder;
}
/// Minimum step of a ray below the ground: 2^-12 of a cell, plus the rounding of times. It may skip shorter stretches
/// above the ground.
SCARP_FN float scarp_least_under(ScarpWay way, float s) {
  return 2.44140625e-4f * way.blind + 4.76837158203125e-7f * s;
}

/// Moves from state.s, a point over ground if `known`, to time s.
SCARP_FN void scarp_step_to(float s, bool known, float clearance, SCARP_INOUT(ScarpMarchState) state) {
  state.before = state.s;
  state.h_before = clearance;
  state.phase = (state.phase & ~kScarpKnown) | (known ? kScarpKnown : 0u);
  state.s = s;
  state.steps += 1;
}

SCARP_GLSL_END

#endif
