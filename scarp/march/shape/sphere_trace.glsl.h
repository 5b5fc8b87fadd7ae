// SPDX-License-Identifier: MIT
// `sphere-trace` for shaders: ball bounds only, in floats, whereas sphere_trace.h also uses segment bounds. r is the
// error of values: ScarpFunctionRay::rounding at the ray's start, growing with the distance.
//
//   outside   the next step is the value minus r; a hit if that is at most r or the tolerance, followed by a few steps
//             by the whole value, to the surface as floats resolve it
//   inside    the same with opposite sign, and across the surface by a step of 2 r
//   from the surface: a step of r; then the solid counts as 4 r thinner, until the ray is 4 r away from it
//
// Guarantee: conservative, including rounding: it misses no crossing deeper than 4 r; a hit is a crossing or a point
// within 4 r or the tolerance of one. Rays that graze faces or balls take many steps, and may exceed the limit:
// exhausted, never a hit.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0; the including file must define what shape_distance.glsl.h requires.
#ifndef SCARP_MARCH_SPHERE_TRACE_GLSL_H
#define SCARP_MARCH_SPHERE_TRACE_GLSL_H

#include "scarp/march/ray_states.glsl.h"
#include "scarp/march/shape/shape_distance.glsl.h"
#include "scarp/march/two_float.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// SphereTraceSettings of march_settings.h.
struct ScarpSphereTrace {
  float tolerance;  ///< length of the last interval, per unit of distance travelled, >= 0
  int max_steps;    ///< >= 1; beyond it: kScarpFunctionExhausted
  int run_steps;    ///< steps per run before the march is interrupted (kScarpFunctionUnderWay), >= 1
  float growth;     ///< of the error of values, per metre of the ray
};

// State of a ray: ScarpMarchState::phase.
const uint kScarpTraceBegins = 0u;
const uint kScarpTraceInside = 1u;
const uint kScarpTraceLeaves = 2u;  ///< leaving the surface that it starts on, or through which it emerged
const uint kScarpTraceOutside = 3u;
const uint kScarpTraceCloses = 4u;  ///< has hit, and closes in on the surface as floats resolve it
const uint kScarpTraceBegan = 8u;   ///< a bit: it started inside

const int kScarpClosingSteps = 6;

/// Closest hit with the shape of `count` instructions, within the tolerance or the error of values; with `any`, the
/// hit's time is undefined. Misses no crossing deeper than 4 times the error.
SCARP_FN ScarpFunctionHit scarp_sphere_trace(uint count, ScarpFunctionRay ray, ScarpSphereTrace settings, bool any) {
  ScarpFunctionHit hit = scarp_function_miss();
  float r = ray.rounding + settings.growth * (ray.speed * ray.state.s);
  float least_step = r / ray.speed;
  bool began_inside = (ray.state.phase & kScarpTraceBegan) != 0u;
  uint phase = ray.state.phase & 7u;
  float s = ray.state.s;
  if (phase == kScarpTraceBegins && (ray.flags & kScarpFromSurface) != 0u) {
    phase = kScarpTraceLeaves;
    s = least_step;
  }
  int closing = 0;
  float closest = s;
  float nearest = 0.0f;
  if (began_inside) hit.status = kScarpFunctionBelow;
  for (int i = ray.state.steps; s <= ray.exit; ++i) {
    if (phase != kScarpTraceCloses) {
      if (i == settings.max_steps) {
        scarp_function_tell(kScarpFunctionExhausted, s, hit);
        return hit;
      }
      if (i - ray.state.steps == settings.run_steps) {
        hit.status = kScarpFunctionUnderWay;
        hit.state.s = s;
        hit.state.steps = i;
        hit.state.phase = phase | (began_inside ? kScarpTraceBegan : 0u);
        return hit;
      }
    }
    r = ray.rounding + settings.growth * (ray.speed * s);
    least_step = r / ray.speed;
    hit.heights += 1u;
    float f = scarp_shape_distance(
        count,
        vec3(scarp_two_line(0.0f, ray.origin.x, ray.origin_low.x, ray.direction.x, ray.direction_low.x, s).high,
             scarp_two_line(0.0f, ray.origin.y, ray.origin_low.y, ray.direction.y, ray.direction_low.y, s).high,
             scarp_two_line(0.0f, ray.origin.z, ray.origin_low.z, ray.direction.z, ray.direction_low.z, s).high));
    if (phase == kScarpTraceCloses) {
      // Past the nearest point the ray would recede again.
      if (f >= nearest) break;
      closest = s;
      nearest = f;
      float next = s + f / ray.speed;
      if (f <= 0.0f || ++closing == kScarpClosingSteps || !(next > s)) break;
      s = next;
      continue;
    }
    if (phase == kScarpTraceBegins) {
      if (abs(f) <= r) {
        scarp_function_tell(kScarpFunctionHit, s, hit);
        return hit;
      }
      began_inside = f < 0.0f;
      phase = began_inside ? kScarpTraceInside : kScarpTraceOutside;
      if (began_inside) hit.status = kScarpFunctionBelow;
    }
    if (phase == kScarpTraceInside) {
      if (f > r) {
        phase = kScarpTraceLeaves;
      } else {
        s += max((-f - r) / ray.speed, 2.0f * least_step);
        continue;
      }
    }
    if (phase == kScarpTraceLeaves && f > 4.0f * r) phase = kScarpTraceOutside;
    float free = (f + (phase == kScarpTraceLeaves ? 4.0f * r : 0.0f) - r) / ray.speed;
    float least = max(max(least_step, settings.tolerance * (s + ray.travelled)), 1.1920928955078125e-7f * s);
    if (phase == kScarpTraceLeaves ? free <= least_step : free <= least) {
      // Out of the solid and back in at once: it was never outside.
      if (phase == kScarpTraceLeaves && began_inside) {
        phase = kScarpTraceInside;
        s += 2.0f * least_step;
        continue;
      }
      hit.status = kScarpFunctionHit;
      closest = s;
      if (any || phase == kScarpTraceLeaves) break;
      phase = kScarpTraceCloses;
      nearest = f;
      s += max(f, 0.0f) / ray.speed;
      continue;
    }
    // Reduced by the rounding of the sum.
    s += max(free - 1.1920928955078125e-7f * (s + free), 0.5f * free);
  }
  if (hit.status == kScarpFunctionHit) hit.time = closest;
  return hit;
}

SCARP_GLSL_END

#endif
