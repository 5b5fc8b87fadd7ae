// SPDX-License-Identifier: MIT
// `lipschitz` for shaders: the march of lipschitz.h in single precision. Guarantee: conservative, as there, but for
// rounding (doc/dev/numerics.md, "Single precision"). Text of C++ and of GLSL, GLSL ES 3.0 included; who includes it
// has defined what cell_surface.glsl.h asks for, and, for fields with holes, scarp_minimum of max_mip.glsl.h.
#ifndef SCARP_MARCH_LIPSCHITZ_GLSL_H
#define SCARP_MARCH_LIPSCHITZ_GLSL_H

#include "scarp/march/height/height_probe.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// LipschitzSettings of march_settings.h.
struct ScarpLipschitz {
  float shrink;     ///< of the vertical distance: 1 / sqrt(1 + c^2), c the field's slope bound
  float tolerance;  ///< distance to the ground that is a hit, per unit of distance travelled, >= 0
  int max_steps;    ///< points that are looked at, >= 1; more: kScarpExhausted
};

/// Time until the ray leaves cell numbers [begin, end) of an axis, from a place in cell number `cell`; places are
/// rounded, here and there, by half a unit.
SCARP_FN float scarp_time_to_border(int begin, int end, int cell, float place, float direction, float per_direction) {
  if (direction == 0.0f) return kScarpNever;
  return (float((direction > 0.0f ? end : begin) - cell) - place) * per_direction + kScarpUnit * abs(per_direction);
}

/// When the ray, over a point at s, leaves the block of 2^level x 2^level cells that holds it: a little later, so that
/// it has, by 2^-20 of a cell and what times round by: 3 units of the way ahead, 2.5 more where the device divides, and
/// 2 of the sum.
SCARP_FN float scarp_leave_time(ScarpField field, ScarpRay ray, ScarpPoint point, int level, float s) {
  int col = (point.cell.x >> level) << level;
  int row = (point.cell.y >> level) << level;
  float x = scarp_time_to_border(col, min(col + (1 << level), field.cells.x), point.cell.x, point.place.x,
                                 ray.direction.x, ray.per_direction.x);
  float y = scarp_time_to_border(row, min(row + (1 << level), field.cells.y), point.cell.y, point.place.y,
                                 ray.direction.y, ray.per_direction.y);
  float ahead = max(0.0f, min(x, y));
  return s + (ahead + 9.5367431640625e-7f * ray.cell_time + 8.0f * kScarpUnit * (s + ahead));
}

/// The time of the first point that the march looks at: a step off the surface.
SCARP_FN float scarp_lipschitz_begin(ScarpRay ray) {
  return (ray.flags & kScarpOnSurface) != 0u ? ray.cell_time : 0.0f;
}

/// On from time s, for some turns, at least a step. False: it is not done. Hosts whose drivers limit the turns of loops
/// interrupt it so and go on with the same s and hit. Over holes a step counts as all the levels that it may climb:
/// invocations in a vector wait for one another, whichever climbs.
SCARP_FN bool scarp_lipschitz_on(ScarpField field, ScarpRay ray, ScarpLipschitz settings, int turns,
                                 SCARP_INOUT(float) s, SCARP_INOUT(ScarpHit) hit) {
  int turns_of_step = (field.flags & kScarpHoles) != 0u ? 1 + field.top_level : 1;
  for (int turn = 0; turn < turns; turn += turns_of_step) {
    if (!(s <= ray.exit)) return true;
    if (int(hit.steps) == settings.max_steps) {
      scarp_give_up(s, hit);
      return true;
    }
    hit.steps += 1u;
    hit.fetches += 4u;
    ScarpPoint point = scarp_point(field, ray, s);
    float free = point.clearance * settings.shrink * ray.per_height;
    if (!point.valid) {
      s = scarp_leave_time(field, ray, point, 0, s);
    } else if (point.clearance < 0.0f) {
      // Under the ground: there from the start, or out of a hole.
      if ((ray.flags & kScarpOnSurface) != 0u && hit.steps == 1u)
        scarp_tell_point(point, s, kScarpHit, hit);
      else if ((field.flags & kScarpSolid) != 0u && s + ray.travelled > 0.0f)
        scarp_tell_point(point, s, kScarpWall, hit);
      else if (hit.steps == 1u)
        hit.status = kScarpBelow;
      else
        scarp_give_up(s, hit);
      return true;
    } else if (free <= settings.tolerance * (s + ray.travelled)) {
      scarp_tell_point(point, s, kScarpHit, hit);
      return true;
    } else if ((field.flags & kScarpHoles) == 0u) {
      s += free;
    } else {
      // No further than the largest block round the point that has no hole; level 0 is the cell.
      int level = 0;
      while (level < field.top_level) {
        hit.fetches += 1u;
        if (scarp_minimum(level + 1, point.cell.x >> (level + 1), point.cell.y >> (level + 1)) == 0.0f) break;
        ++level;
      }
      s = min(s + free, scarp_leave_time(field, ray, point, level, s));
    }
  }
  return false;
}

/// A ray of scarp_ray(), scarp_ray_from() or sampled_device_ray() (device_ray.h), to its exit: the first point within
/// the tolerance above the ground; none is passed, but for rounding, as long as `shrink` is right. A ray from the
/// surface is looked at from a cell away on. The answer's time counts from the ray's begin.
SCARP_FN ScarpHit scarp_lipschitz(ScarpField field, ScarpRay ray, ScarpLipschitz settings) {
  ScarpHit hit = scarp_no_hit();
  float s = scarp_lipschitz_begin(ray);
  while (!scarp_lipschitz_on(field, ray, settings, kScarpAllTurns, s, hit)) {
  }
  return hit;
}

SCARP_GLSL_END

#endif
