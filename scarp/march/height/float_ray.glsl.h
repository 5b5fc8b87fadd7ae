// SPDX-License-Identifier: MIT
// Rays for hosts without doubles: shaders that generate their own rays.
//
// They have float precision: the start of the ray has an error of one unit roundoff of its coordinates, so the columns
// and rows of cameras should be near the field or, if it wraps, near the point that they look at. The march of that ray
// is as exact as any other; the bound of doc/dev/numerics.md includes 1 / direction by a division accurate to 2.5
// units, as in Vulkan.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0.
#ifndef SCARP_MARCH_FLOAT_RAY_GLSL_H
#define SCARP_MARCH_FLOAT_RAY_GLSL_H

#include "scarp/march/height/ray_frame.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// A ray from a position over the field. `direction` is in columns, rows and sample units per time and is not zero; the
/// ray's time is in lengths of it divided by the larger of abs x, abs y (upright: abs z), and `end` is the last such
/// time. `flags` may be kScarpOnSurface, then z is not read, or, for a start above the highest sample, kScarpAbove.
SCARP_FN ScarpRay scarp_ray(ivec2 cell, vec2 place, float z, vec3 direction, float end, uint flags) {
  float speed = max(abs(direction.x), abs(direction.y));
  ScarpRay ray;
  ray.flags = flags;
  if (!(speed > 0.0f)) {
    speed = abs(direction.z);
    ray.flags |= kScarpUpright;
  }
  ray.cell = cell;
  ray.place = place;
  ray.place_low = vec2(0.0f, 0.0f);
  ray.direction = vec3(direction.x / speed, direction.y / speed, direction.z / speed);
  ray.direction_low = vec3(0.0f, 0.0f, 0.0f);
  ray.per_direction =
      vec2(ray.direction.x == 0.0f ? kScarpNever : clamp(1.0f / ray.direction.x, -kScarpNever, kScarpNever),
           ray.direction.y == 0.0f ? kScarpNever : clamp(1.0f / ray.direction.y, -kScarpNever, kScarpNever));
  ray.z = z;
  ray.z_low = 0.0f;
  ray.end = end;
  ray.end_low = 0.0f;
  // For the sampling marches, with cells as wide as a sample unit is high.
  float length_of =
      sqrt(ray.direction.x * ray.direction.x + ray.direction.y * ray.direction.y + ray.direction.z * ray.direction.z);
  ray.travelled = 0.0f;
  ray.exit = end;
  ray.per_height = 1.0f / length_of;
  ray.cell_time = 1.0f / length_of;
  return ray;
}

/// A ray from anywhere: `origin` in columns, rows and sample units from sample (0, 0). It is clipped as by `cast`: to
/// the border, unless the field wraps round; an upright ray without an end also to the range of the samples.
/// `travelled` is the time up to there, in the unit of `end`. Returns false if the ray does not reach the field; the
/// ray is then undefined.
SCARP_FN bool scarp_ray_from(ScarpField field, vec3 origin, vec3 direction, float end, SCARP_OUT(ScarpRay) ray) {
  ray = scarp_ray(ivec2(0, 0), vec2(0.0f, 0.0f), origin.z, direction, end, 0u);
  float border = -kScarpNever;  // where the ray enters the field
  float exit = end;
  bool wraps = (field.flags & kScarpWraps) != 0u;
  vec2 size = vec2(float(field.cells.x), float(field.cells.y));
  if (!wraps) {
    float east = (size.x - origin.x) * ray.per_direction.x;
    float west = -origin.x * ray.per_direction.x;
    float south = (size.y - origin.y) * ray.per_direction.y;
    float north = -origin.y * ray.per_direction.y;
    if (ray.direction.x != 0.0f) {
      border = max(border, min(east, west));
      exit = min(exit, max(east, west));
    } else if (origin.x < 0.0f || origin.x > size.x) {
      return false;
    }
    if (ray.direction.y != 0.0f) {
      border = max(border, min(north, south));
      exit = min(exit, max(north, south));
    } else if (origin.y < 0.0f || origin.y > size.y) {
      return false;
    }
    if (border >= 0.0f) ray.flags |= kScarpFromOutside;
  }
  float begin = max(border, 0.0f);
  if ((ray.flags & kScarpUpright) != 0u && !(exit < kScarpNever)) {
    float top = (field.highest - origin.z) / ray.direction.z;
    float bottom = (field.lowest - origin.z) / ray.direction.z;
    begin = max(begin, min(top, bottom));
    exit = max(top, bottom);
  }
  if (!(begin <= exit)) return false;
  vec2 at = vec2(origin.x + ray.direction.x * begin, origin.y + ray.direction.y * begin);
  vec2 corner = vec2(floor(at.x), floor(at.y));
  if (!wraps) corner = vec2(clamp(corner.x, 0.0f, size.x - 1.0f), clamp(corner.y, 0.0f, size.y - 1.0f));
  // A ray that does not move along an axis stays in its cell.
  ray.place = vec2(clamp(at.x - corner.x, 0.0f, ray.direction.x == 0.0f ? 1.0f - kScarpUnit : 1.0f),
                   clamp(at.y - corner.y, 0.0f, ray.direction.y == 0.0f ? 1.0f - kScarpUnit : 1.0f));
  if (wraps) corner = vec2(corner.x - floor(corner.x / size.x) * size.x, corner.y - floor(corner.y / size.y) * size.y);
  ray.cell = ivec2(min(int(corner.x), field.cells.x - 1), min(int(corner.y), field.cells.y - 1));
  ray.z = origin.z + ray.direction.z * begin;
  ray.travelled = begin;
  ray.exit = exit - begin;
  ray.end = end - begin;
  return true;
}

SCARP_GLSL_END

#endif
