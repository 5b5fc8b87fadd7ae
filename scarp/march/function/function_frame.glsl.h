// SPDX-License-Identifier: MIT
// A ray over a terrain function in single precision, and its height above the ground.
//
// The host clips the ray to the range of the ground's heights, in double (device_function_ray.h). From there, times
// count from 0 in units of the direction, whose length is 1 to 2 metres: it is the ray's own, scaled by a power of two.
// Every number is two floats, 48 bits; a time is one float and exact: the point follows from the ray's own numbers.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0. The including file must define scarp_instruction(), see
// function_heights.glsl.h.
#ifndef SCARP_MARCH_FUNCTION_FRAME_GLSL_H
#define SCARP_MARCH_FUNCTION_FRAME_GLSL_H

#include "scarp/march/function/function_heights.glsl.h"
#include "scarp/march/ray_states.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Returns x of the ray's point at time s, in metres.
SCARP_FN ScarpTwoFloat scarp_ray_x(ScarpFunctionRay ray, float s) {
  return scarp_two_line(0.0f, ray.origin.x, ray.origin_low.x, ray.direction.x, ray.direction_low.x, s);
}
/// Returns y of the ray's point at time s, in metres.
SCARP_FN ScarpTwoFloat scarp_ray_y(ScarpFunctionRay ray, float s) {
  return scarp_two_line(0.0f, ray.origin.y, ray.origin_low.y, ray.direction.y, ray.direction_low.y, s);
}
/// Returns the height of the ray's point at time s, in metres.
SCARP_FN ScarpTwoFloat scarp_ray_z(ScarpFunctionRay ray, float s) {
  return scarp_two_line(0.0f, ray.origin.z, ray.origin_low.z, ray.direction.z, ray.direction_low.z, s);
}

/// Returns the height of the ray above the ground at time s, in metres, accurate to ray.rounding plus one unit
/// roundoff.
SCARP_FN float scarp_clearance(ScarpProgram program, ScarpFunctionRay ray, float s) {
  ScarpTwoFloat ground = scarp_height(program, scarp_ray_x(ray, s), scarp_ray_y(ray, s));
  return scarp_two_add(scarp_ray_z(ray, s), scarp_two_negate(ground)).high;
}

SCARP_GLSL_END

#endif
