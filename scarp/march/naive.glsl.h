// SPDX-License-Identifier: MIT
// `naive` for shaders: the march of naive.h in single precision. Guarantee: approximate, as there. Text of C++ and of
// GLSL, GLSL ES 3.0 included; who includes it has defined what cell_surface.glsl.h asks for.
#ifndef SCARP_MARCH_NAIVE_GLSL_H
#define SCARP_MARCH_NAIVE_GLSL_H

#include "scarp/march/height/height_probe.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// NaiveSettings of march_settings.h.
struct ScarpNaive {
  float step_factor;  ///< of the vertical distance h, > 0
  float min_step;     ///< least step, as a share of the ray's length to the field's border, > 0
  float tolerance;    ///< height above the ground that is a hit, per unit of distance, >= 0
  int max_steps;      ///< points that are looked at, >= 1; more: kScarpExhausted
};

/// The least step, a time.
SCARP_FN float scarp_naive_least(ScarpRay ray, ScarpNaive settings) {
  return settings.min_step * (ray.travelled + ray.exit);
}

/// The time of the first point that the march looks at.
SCARP_FN float scarp_naive_begin(ScarpRay ray, ScarpNaive settings) {
  return (ray.flags & kScarpOnSurface) != 0u ? scarp_naive_least(ray, settings) : 0.0f;
}

/// On from time s, for some turns. False: it is not done. Hosts whose drivers limit the turns of loops interrupt it so
/// and go on with the same s and hit.
SCARP_FN bool scarp_naive_on(ScarpField field, ScarpRay ray, ScarpNaive settings, int turns, SCARP_INOUT(float) s,
                             SCARP_INOUT(ScarpHit) hit) {
  float least = scarp_naive_least(ray, settings);
  for (int turn = 0; turn < turns; ++turn) {
    if (!(s <= ray.exit)) return true;
    if (int(hit.steps) == settings.max_steps) {
      scarp_give_up(s, hit);
      return true;
    }
    hit.steps += 1u;
    hit.fetches += 4u;
    ScarpPoint point = scarp_point(field, ray, s);
    float h = point.clearance * ray.per_height;
    if (point.valid && h < settings.tolerance * (s + ray.travelled)) {
      scarp_tell_point(point, s, kScarpHit, hit);
      return true;
    }
    // Over a hole there is no height to go by.
    s += max(point.valid ? settings.step_factor * abs(h) : 0.0f, least);
  }
  return false;
}

/// A ray of scarp_ray(), scarp_ray_from() or sampled_device_ray() (device_ray.h), to its exit: the first point that is
/// not above the ground by more than the tolerance, one-sided, so that points below it are hits wherever they are. The
/// answer's time counts from the ray's begin. Passes over what is thinner than a step.
SCARP_FN ScarpHit scarp_naive(ScarpField field, ScarpRay ray, ScarpNaive settings) {
  ScarpHit hit = scarp_no_hit();
  float s = scarp_naive_begin(ray, settings);
  while (!scarp_naive_on(field, ray, settings, kScarpAllTurns, s, hit)) {
  }
  return hit;
}

SCARP_GLSL_END

#endif
