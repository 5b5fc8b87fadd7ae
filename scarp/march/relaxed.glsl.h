// SPDX-License-Identifier: MIT
// `relaxed` for shaders: the march of relaxed.h in single precision. Guarantee: approximate, as there. Text of C++ and
// of GLSL, GLSL ES 3.0 included; who includes it has defined what cell_surface.glsl.h asks for.
#ifndef SCARP_MARCH_RELAXED_GLSL_H
#define SCARP_MARCH_RELAXED_GLSL_H

#include "scarp/march/ground.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// RelaxedSettings of marches.h.
struct ScarpRelaxed {
  float step_factor;
  float tolerance;
  int max_steps;
};

/// What the march finds first.
SCARP_FN ScarpHit scarp_relaxed(ScarpField field, ScarpRay ray, ScarpRelaxed settings) {
  ScarpHit hit = scarp_no_hit();
  bool on_surface = (ray.flags & kScarpOnSurface) != 0u;
  // The first step off the surface.
  float s = on_surface ? ray.cell_time : 0.0f;
  for (int i = 0; s <= ray.exit; ++i) {
    if (i == settings.max_steps) {
      scarp_give_up(s, hit);
      return hit;
    }
    hit.steps += 1u;
    hit.fetches += 4u;
    ScarpPoint point = scarp_point(field, ray, s);
    float h = point.clearance * ray.per_height;
    if (!point.valid) {
      s += ray.cell_time;
    } else if (abs(h) < settings.tolerance * (s + ray.travelled)) {
      scarp_tell_point(point, s, kScarpHit, hit);
      return hit;
    } else if (h < 0.0f && i == 0) {
      // Below at the first look: the way back would leave the ray's range.
      if (on_surface)
        scarp_tell_point(point, s, kScarpHit, hit);
      else
        hit.status = kScarpBelow;
      return hit;
    } else {
      s = max(s + settings.step_factor * h, 0.0f);
    }
  }
  return hit;
}

SCARP_GLSL_END

#endif
