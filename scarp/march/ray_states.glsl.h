// SPDX-License-Identifier: MIT
// Rays for the single-precision marches over terrain functions and distance fields, and their results. The host
// prepares rays in double (device_function_ray.h): clipped to the part that can hit the field, every number as two
// floats, with times counting from there.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0.
#ifndef SCARP_MARCH_RAY_STATES_GLSL_H
#define SCARP_MARCH_RAY_STATES_GLSL_H

#include "scarp/march/march_state.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

const uint kScarpFromSurface = 1u;  ///< ScarpFunctionRay::flags: starts on the surface, above it by definition

/// A ray, in metres.
struct ScarpFunctionRay {
  vec3 origin;
  vec3 origin_low;
  vec3 direction;  ///< 1 to 2 long
  vec3 direction_low;
  float exit;       ///< the last time, included
  float travelled;  ///< time from the start of the ray's range to its origin here
  float speed;      ///< length of the direction
  float rounding;   ///< error bound of computed clearances, in metres
  uint flags;       ///< kScarpFromSurface and so on
  ScarpMarchState state;
};

const int kScarpFunctionMiss = kScarpMiss;
const int kScarpFunctionHit = kScarpHit;
const int kScarpFunctionBelow = kScarpBelow;
const int kScarpFunctionExhausted = kScarpExhausted;
const int kScarpFunctionUnderWay = 4;  ///< not done: march the same ray again, from `state`

/// The result; time is defined for hits and exhausted.
struct ScarpFunctionHit {
  int status;
  float time;
  uint bounds;   ///< number of bounds of segments
  uint heights;  ///< number of heights
  ScarpMarchState state;
};

/// A miss without cost: the initial state of marches.
SCARP_FN ScarpFunctionHit scarp_function_miss() {
  ScarpFunctionHit hit;
  hit.status = kScarpFunctionMiss;
  hit.time = 0.0f;
  hit.bounds = 0u;
  hit.heights = 0u;
  hit.state.s = 0.0f;
  hit.state.before = 0.0f;
  hit.state.h_before = 0.0f;
  hit.state.steps = 0;
  hit.state.phase = 0u;
  return hit;
}
/// Sets the status and time of a result.
SCARP_FN void scarp_function_tell(int status, float s, SCARP_INOUT(ScarpFunctionHit) hit) {
  hit.status = status;
  hit.time = s;
}

SCARP_GLSL_END

#endif
