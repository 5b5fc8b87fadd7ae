// SPDX-License-Identifier: MIT
// `naive` for shaders: the march of naive.h in single precision. Guarantee: approximate, as there. Text of C++ and of
// GLSL, GLSL ES 3.0 included; who includes it has defined what cell_surface.glsl.h asks for.
#ifndef SCARP_MARCH_NAIVE_GLSL_H
#define SCARP_MARCH_NAIVE_GLSL_H

#include "scarp/march/ground.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// NaiveSettings of marches.h.
struct ScarpNaive {
  float step_factor;
  float min_step;
  float tolerance;
  int max_steps;
};

/// What the march finds first.
SCARP_FN ScarpHit scarp_naive(ScarpField field, ScarpRay ray, ScarpNaive settings) {
  ScarpHit hit = scarp_no_hit();
  float least = settings.min_step * (ray.travelled + ray.exit);
  float s = (ray.flags & kScarpOnSurface) != 0u ? least : 0.0f;
  for (int i = 0; s <= ray.exit; ++i) {
    if (i == settings.max_steps) {
      scarp_give_up(s, hit);
      return hit;
    }
    hit.steps += 1u;
    hit.fetches += 4u;
    ScarpPoint point = scarp_point(field, ray, s);
    float h = point.clearance * ray.per_height;
    if (point.valid && h < settings.tolerance * (s + ray.travelled)) {
      scarp_tell_point(point, s, kScarpHit, hit);
      return hit;
    }
    // Over a hole there is no height to go by.
    s += max(point.valid ? settings.step_factor * abs(h) : 0.0f, least);
  }
  return hit;
}

SCARP_GLSL_END

#endif
