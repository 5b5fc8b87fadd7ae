// SPDX-License-Identifier: MIT
// A ray over a terrain function in single precision, and what the marches ask of it: how high it is above the ground.
//
//   The host clips the ray to the range of the ground's heights, in double (device_function_ray.h). From there times
//   count from 0 in lengths of the direction, which is 1 to 2 metres long: a power of two of the ray's own. Every
//   number is two floats, 48 bits; a time is one float, and has no error: the point follows from the ray's own numbers.
//
// Text of C++ and of GLSL, GLSL ES 3.0 included. Who includes it has defined scarp_instruction(), see
// function_heights.glsl.h.
#ifndef SCARP_MARCH_FUNCTION_FRAME_GLSL_H
#define SCARP_MARCH_FUNCTION_FRAME_GLSL_H

#include "scarp/march/function_heights.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

const uint kScarpFromSurface = 1u;  ///< ScarpFunctionRay::flags: begins on the surface, above it by definition

/// Where a march is that has been interrupted, see ScarpFunctionHit; of a ray that has not begun steps and phase are 0.
struct ScarpFunctionState {
  float s;       ///< time
  float before;  ///< what else the march has to know
  float h_before;
  int steps;  ///< that it has taken
  uint phase;
};

/// A ray, metres.
struct ScarpFunctionRay {
  vec3 origin;
  vec3 origin_low;
  vec3 direction;  ///< 1 to 2 long
  vec3 direction_low;
  float exit;       ///< the last time, included
  float travelled;  ///< time from the begin of the ray's range to its origin here
  float speed;      ///< length of the direction
  float rounding;   ///< metres by which clearances as computed may be off
  uint flags;       ///< kScarpFromSurface and so on
  ScarpFunctionState state;
};

const int kScarpFunctionMiss = 0;
const int kScarpFunctionHit = 1;
const int kScarpFunctionBelow = 2;
const int kScarpFunctionExhausted = 3;
const int kScarpFunctionUnderWay = 4;  ///< not done: march the same ray again, from `state`

/// The answer; time means something for hits and exhausted.
struct ScarpFunctionHit {
  int status;
  float time;
  uint bounds;   ///< of segments that were asked for
  uint heights;  ///< that were looked at
  ScarpFunctionState state;
};

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
SCARP_FN void scarp_function_tell(int status, float s, SCARP_INOUT(ScarpFunctionHit) hit) {
  hit.status = status;
  hit.time = s;
}

/// Coordinates of the ray's point at time s.
SCARP_FN ScarpTwoFloat scarp_ray_x(ScarpFunctionRay ray, float s) {
  return scarp_two_line(0.0f, ray.origin.x, ray.origin_low.x, ray.direction.x, ray.direction_low.x, s);
}
SCARP_FN ScarpTwoFloat scarp_ray_y(ScarpFunctionRay ray, float s) {
  return scarp_two_line(0.0f, ray.origin.y, ray.origin_low.y, ray.direction.y, ray.direction_low.y, s);
}
SCARP_FN ScarpTwoFloat scarp_ray_z(ScarpFunctionRay ray, float s) {
  return scarp_two_line(0.0f, ray.origin.z, ray.origin_low.z, ray.direction.z, ray.direction_low.z, s);
}

/// Metres that the ray is above the ground at time s, within ray.rounding and a unit of itself.
SCARP_FN float scarp_clearance(ScarpProgram program, ScarpFunctionRay ray, float s) {
  ScarpTwoFloat ground = scarp_height(program, scarp_ray_x(ray, s), scarp_ray_y(ray, s));
  return scarp_two_add(scarp_ray_z(ray, s), scarp_two_negate(ground)).high;
}

SCARP_GLSL_END

#endif
