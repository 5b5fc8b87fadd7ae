// SPDX-License-Identifier: MIT
// `lipschitz` for shaders: the march of lipschitz.h in single precision. Guarantee: conservative, as there, except for
// rounding (doc/dev/numerics.md, "Single precision"); over functions rounding is included. Without
// ScarpSampling::proven: approximate.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0.
#ifndef SCARP_MARCH_SAMPLING_LIPSCHITZ_GLSL_H
#define SCARP_MARCH_SAMPLING_LIPSCHITZ_GLSL_H

#include "scarp/march/sampling/sampling.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Makes settings; see LipschitzSettings. `shrink` is at most 1 / sqrt(1 + c^2), c the field's slope bound; for a
/// larger one set `proven` of the result to 0.
SCARP_FN ScarpSampling scarp_lipschitz(float shrink, float tolerance, int max_steps) {
  return scarp_sampling(kScarpLipschitz, shrink, 0.0f, tolerance, max_steps, kScarpRefineNone);
}

/// Returns the status of the point at state.s, over ground if `valid`; or kScarpMiss, and moves to the next: no further
/// than `until`, and over a hole to `until`.
SCARP_FN int scarp_lipschitz_turn(ScarpWay way, ScarpSampling settings, bool valid, float clearance, float until,
                                  SCARP_INOUT(ScarpMarchState) state) {
  int status = kScarpMiss;
  float next = until;
  bool first = state.steps == 0;
  bool sunk = valid && clearance < -way.rounding;
  bool comes_in = scarp_comes_in_under(way, valid, clearance, state);
  // Below the ground the bound on the distance is the same as above it.
  float free = ((sunk ? -clearance : clearance) - way.rounding) * settings.factor * way.per_clearance;
  float limit = settings.tolerance * (state.s + way.travelled);
  float least = scarp_least_under(way, state.s);
  scarp_mark_under(comes_in, valid, clearance, !sunk && free > max(limit, least), state);
  bool under = (state.phase & kScarpUnder) != 0u;
  // A ray that enters may have touched the edge of the ground, which is a hit, just above or at the corner of a hole.
  bool proven = settings.proven != 0u;
  bool unsure = comes_in && (free <= least || (!first && proven));
  if (comes_in && way.solid) {
    status = kScarpWall;
  } else if (sunk && (unsure || !under)) {
    int passed = proven ? kScarpExhausted : kScarpHit;
    status = !first || unsure ? passed : way.from_surface ? kScarpHit : kScarpBelow;
  } else if (valid && under) {
    next = min(state.s + max(free, least), until);
  } else if (valid) {
    // Reduced by the rounding of the sum. A step that is too short to advance is a hit.
    next = state.s + (free - 1.1920928955078125e-7f * (state.s + free));
    if (free <= limit || !(next > state.s)) status = kScarpHit;
    next = min(next, until);
  }
  if (status == kScarpMiss) scarp_step_to(next, valid, clearance, state);
  return status;
}

SCARP_GLSL_END

#endif
