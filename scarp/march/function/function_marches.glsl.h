// SPDX-License-Identifier: MIT
// `naive`, `fixed-step`, `relaxed` and `lipschitz` over a terrain function, for shaders: the turns of naive.glsl.h and
// so on, driven by the probe of function_frame.glsl.h.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0. The including file must define scarp_instruction(), see
// function_heights.glsl.h.
#ifndef SCARP_MARCH_FUNCTION_MARCHES_GLSL_H
#define SCARP_MARCH_FUNCTION_MARCHES_GLSL_H

#include "scarp/march/function/function_frame.glsl.h"
#include "scarp/march/sampling/sampling_marches.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// A ray over a function. Clearances are in metres.
SCARP_FN ScarpWay scarp_way(ScarpFunctionRay ray, ScarpSampling settings) {
  ScarpWay way;
  way.exit = ray.exit;
  way.last = ray.exit;
  way.travelled = ray.travelled;
  way.per_clearance = 1.0f / ray.speed;
  way.rounding = ray.rounding;
  way.blind = 9.765625e-4f * ray.exit;  // as there are no cells
  way.stride = settings.factor / ray.speed;
  way.from_surface = (ray.flags & kScarpFromSurface) != 0u;
  way.from_outside = ray.travelled > 0.0f;
  way.solid = false;
  return way;
}

/// Returns the first hit of a ray over the ground of a program. Interrupts itself (kScarpFunctionUnderWay) after
/// `run_steps` more steps, at least one.
SCARP_FN ScarpFunctionHit scarp_function_march(ScarpProgram program, ScarpFunctionRay ray, ScarpSampling settings,
                                               int run_steps) {
  ScarpFunctionHit hit = scarp_function_miss();
  ScarpWay way = scarp_way(ray, settings);
  ScarpMarchState state = ray.state;
  if (state.steps == 0) state = scarp_sampling_begin(way, settings);
  float clearance = 0.0f;
  for (int step = 0; hit.status == kScarpFunctionMiss; ++step) {
    if (!(state.s <= ray.exit)) {
      hit.status = scarp_sampling_missed(state);
      return hit;
    }
    if (state.steps == settings.max_steps) {
      scarp_function_tell(kScarpFunctionExhausted, scarp_sampling_reached(settings, state), hit);
      return hit;
    }
    if (step == run_steps) {
      hit.status = kScarpFunctionUnderWay;
      hit.state = state;
      return hit;
    }
    hit.heights += 1u;
    clearance = scarp_clearance(program, ray, state.s);
    hit.status = scarp_sampling_turn(way, settings, true, clearance, kScarpNever, state);
  }
  hit.time = state.s;
  // Refined after the loop: there neighbours in a vector, which stop at different steps, refine together.
  if (hit.status != kScarpFunctionHit || !scarp_sampling_refines(settings, state)) return hit;
  if (settings.refinement != kScarpRefineBisect) {
    hit.time = scarp_sampling_secant(way, settings, clearance, state);
    return hit;
  }
  float from = state.before;
  for (int i = 0; i < settings.halvings; ++i) {
    float s = 0.5f * (from + hit.time);
    hit.heights += 1u;
    if (scarp_sampling_stops(way, settings, s, scarp_clearance(program, ray, s)))
      hit.time = s;
    else
      from = s;
  }
  return hit;
}

SCARP_GLSL_END

#endif
