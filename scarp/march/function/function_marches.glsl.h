// SPDX-License-Identifier: MIT
// `naive`, `fixed-step`, `relaxed` and `lipschitz` over a terrain function, for shaders: function_marches.h in single
// precision.
//
// Text of C++ and of GLSL, GLSL ES 3.0 included. Who includes it has defined scarp_instruction(), see
// function_heights.glsl.h.
#ifndef SCARP_MARCH_FUNCTION_MARCHES_GLSL_H
#define SCARP_MARCH_FUNCTION_MARCHES_GLSL_H

#include "scarp/march/function/function_frame.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// Which march, where one text serves several.
const uint kScarpFunctionNaive = 0u;
const uint kScarpFunctionFixedStep = 1u;
const uint kScarpFunctionRelaxed = 2u;
const uint kScarpFunctionLipschitz = 3u;

// The values of Refinement.
const uint kScarpRefineNone = 0u;
const uint kScarpRefineSecant = 1u;
const uint kScarpRefineBisect = 2u;

/// MarchSettings of marches.h, those of one march.
struct ScarpFunctionMarch {
  float factor;     ///< naive, relaxed: of the height; lipschitz: shrink factor, rounded down; fixed-step: step, metres
  float least;      ///< naive: least step, a share of the ray's length; fixed-step: share of the distance travelled
  float tolerance;  ///< per unit of distance
  float metres;     ///< naive, relaxed: metres off the ground that are a hit at any distance
  int max_steps;    ///< heights that are looked at, >= 1; more: kScarpFunctionExhausted
  uint refinement;  ///< of the last interval: kScarpRefineNone and so on
  int halvings;     ///< of kScarpRefineBisect
  int run_steps;    ///< after so many more steps the march is interrupted (kScarpFunctionUnderWay), at least 1
};

/// Interrupts a march at time s, after so many steps in all.
SCARP_FN void scarp_interrupt(float s, float before, float h_before, int steps, uint phase,
                              SCARP_INOUT(ScarpFunctionHit) hit) {
  hit.status = kScarpFunctionUnderWay;
  hit.state.s = s;
  hit.state.before = before;
  hit.state.h_before = h_before;
  hit.state.steps = steps;
  hit.state.phase = phase;
}

/// The blind first step from the surface, a share of the way out.
const float kScarpBlindStep = 9.765625e-4f;

/// How far off the ground a hit may be at time s, as a time.
SCARP_FN float scarp_hit_limit(uint march, ScarpFunctionMarch settings, ScarpFunctionRay ray, float s) {
  if (march == kScarpFunctionFixedStep) return 0.0f;
  return max(settings.metres / ray.speed, settings.tolerance * (s + ray.travelled));
}
/// Whether a march stops at time s, where the clearance is h, as a time.
SCARP_FN bool scarp_stops(uint march, ScarpFunctionMarch settings, ScarpFunctionRay ray, float s, float h) {
  if (march == kScarpFunctionFixedStep) return h <= 0.0f;
  float limit = scarp_hit_limit(march, settings, ray, s);
  return march == kScarpFunctionNaive ? h < limit : abs(h) < limit;
}

/// Between s0, where the march went on, and s1, where it stops: nearer to where its test begins to hold, which is that
/// of a `limit` beyond which the clearance h0 lies.
SCARP_FN float scarp_refined(ScarpProgram program, ScarpFunctionRay ray, uint march, ScarpFunctionMarch settings,
                             uint refinement, float s0, float h0, float s1, float h1, float limit,
                             SCARP_INOUT(ScarpFunctionHit) hit) {
  if (refinement == kScarpRefineSecant && h0 != h1) {
    return s0 + (s1 - s0) * clamp((h0 - limit) / (h0 - h1), 0.0f, 1.0f);
  }
  float from = s0;
  float to = s1;
  if (refinement == kScarpRefineBisect) {
    for (int i = 0; i < settings.halvings; ++i) {
      float s = 0.5f * (from + to);
      hit.heights += 1u;
      if (scarp_stops(march, settings, ray, s, scarp_clearance(program, ray, s) / ray.speed))
        to = s;
      else
        from = s;
    }
  }
  return to;
}

/// `naive` and `relaxed`: steps by the clearance.
SCARP_FN ScarpFunctionHit scarp_function_by_height(ScarpProgram program, ScarpFunctionRay ray, uint march,
                                                   ScarpFunctionMarch settings) {
  ScarpFunctionHit hit = scarp_function_miss();
  bool naive = march == kScarpFunctionNaive;
  bool from_surface = (ray.flags & kScarpFromSurface) != 0u;
  float least = naive ? settings.least * (ray.exit + ray.travelled) : 0.0f;
  float s = ray.state.steps > 0 ? ray.state.s : !from_surface ? 0.0f : naive ? least : kScarpBlindStep * ray.exit;
  float before = ray.state.before;
  float h_before = ray.state.h_before;
  float h = 0.0f;
  bool stops = false;
  int i = ray.state.steps;
  for (; s <= ray.exit; ++i) {
    if (i == settings.max_steps) {
      scarp_function_tell(kScarpFunctionExhausted, s, hit);
      return hit;
    }
    if (i - ray.state.steps == settings.run_steps) {
      scarp_interrupt(s, before, h_before, i, 0u, hit);
      return hit;
    }
    hit.heights += 1u;
    h = scarp_clearance(program, ray, s) / ray.speed;
    // Refined beyond the loop: there neighbours in a vector, which stop at other steps, do it together.
    if (scarp_stops(march, settings, ray, s, h)) {
      stops = true;
      break;
    }
    if (!naive && h < 0.0f && i == 0) {
      scarp_function_tell(from_surface ? kScarpFunctionHit : kScarpFunctionBelow, s, hit);
      return hit;
    }
    before = s;
    h_before = h;
    s = naive ? s + max(settings.factor * abs(h), least) : max(s + settings.factor * h, 0.0f);
  }
  if (!stops) return hit;
  float limit = scarp_hit_limit(march, settings, ray, s);
  // `relaxed` may come from above or, having overshot, from below.
  if (!naive && h_before < 0.0f) limit = -limit;
  float at = scarp_refined(program, ray, march, settings, i > 0 ? settings.refinement : kScarpRefineNone, before,
                           h_before, s, h, limit, hit);
  scarp_function_tell(kScarpFunctionHit, at, hit);
  return hit;
}

/// `fixed-step` over a function: points at equal distances, or at growing ones with `least`.
SCARP_FN ScarpFunctionHit scarp_function_fixed_step(ScarpProgram program, ScarpFunctionRay ray,
                                                    ScarpFunctionMarch settings) {
  ScarpFunctionHit hit = scarp_function_miss();
  bool from_surface = (ray.flags & kScarpFromSurface) != 0u;
  float stride = settings.factor / ray.speed;
  // Phases: 0, 1 where it began under the ground and is still there, 2 above.
  bool above = ray.state.steps > 0 ? ray.state.phase == 2u : from_surface;
  bool under = ray.state.phase == 1u;
  if (under) hit.status = kScarpFunctionBelow;
  float before = ray.state.before;
  float h_before = ray.state.h_before;
  float s = 0.0f;
  float h = 0.0f;
  int first = max(ray.state.steps, from_surface ? 1 : 0);
  for (int i = first;; ++i) {
    if (i == settings.max_steps) {
      scarp_function_tell(kScarpFunctionExhausted, before, hit);
      return hit;
    }
    if (i - first == settings.run_steps) {
      scarp_interrupt(before, before, h_before, i, above ? 2u : under ? 1u : 0u, hit);
      return hit;
    }
    // Counted, not summed up, while steps are equal.
    s = float(i) * stride;
    if (settings.least > 0.0f && i > 0) s = before + max(stride, settings.least * (before + ray.travelled));
    s = min(s, ray.exit);
    hit.heights += 1u;
    h = scarp_clearance(program, ray, s) / ray.speed;
    if (h > 0.0f || (h == 0.0f && from_surface)) {
      above = true;
    } else if (above && h_before > 0.0f) {
      break;  // refined beyond the loop, see above
    } else if (above || (i == 0 && h == 0.0f)) {
      scarp_function_tell(kScarpFunctionHit, s, hit);
      return hit;
    } else if (i == 0) {
      under = true;
      hit.status = kScarpFunctionBelow;
    }
    before = s;
    h_before = h;
    if (!(s < ray.exit)) return hit;
  }
  float at = scarp_refined(program, ray, kScarpFunctionFixedStep, settings, settings.refinement, before, h_before, s, h,
                           0.0f, hit);
  scarp_function_tell(kScarpFunctionHit, at, hit);
  return hit;
}

/// Never passes the surface, rounding counted: stops above it, within the tolerance or twice the rounding, or gives up.
SCARP_FN ScarpFunctionHit scarp_function_lipschitz(ScarpProgram program, ScarpFunctionRay ray,
                                                   ScarpFunctionMarch settings) {
  ScarpFunctionHit hit = scarp_function_miss();
  bool from_surface = (ray.flags & kScarpFromSurface) != 0u;
  float s = ray.state.steps > 0 ? ray.state.s : from_surface ? kScarpBlindStep * ray.exit : 0.0f;
  for (int i = ray.state.steps; s <= ray.exit; ++i) {
    if (i == settings.max_steps) {
      scarp_function_tell(kScarpFunctionExhausted, s, hit);
      return hit;
    }
    if (i - ray.state.steps == settings.run_steps) {
      scarp_interrupt(s, 0.0f, 0.0f, i, 0u, hit);
      return hit;
    }
    hit.heights += 1u;
    float h = scarp_clearance(program, ray, s);
    if (h < -ray.rounding) {
      scarp_function_tell(from_surface && i == 0 ? kScarpFunctionHit : kScarpFunctionBelow, s, hit);
      return hit;
    }
    float free = (h - ray.rounding) * settings.factor / ray.speed;
    // What the sum below may round up; a step that is too short to be one is no way on.
    float next = s + (free - 1.1920928955078125e-7f * (s + free));
    if (free <= settings.tolerance * (s + ray.travelled) || !(next > s)) {
      scarp_function_tell(kScarpFunctionHit, s, hit);
      return hit;
    }
    s = next;
  }
  return hit;
}

/// The first point that a march (kScarpFunctionNaive and so on) takes for a hit, over the ground of a program.
SCARP_FN ScarpFunctionHit scarp_function_march(ScarpProgram program, ScarpFunctionRay ray, uint march,
                                               ScarpFunctionMarch settings) {
  if (march == kScarpFunctionFixedStep) return scarp_function_fixed_step(program, ray, settings);
  if (march == kScarpFunctionLipschitz) return scarp_function_lipschitz(program, ray, settings);
  return scarp_function_by_height(program, ray, march, settings);
}

SCARP_GLSL_END

#endif
