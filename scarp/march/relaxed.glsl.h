// SPDX-License-Identifier: MIT
// `relaxed` for shaders: the march of relaxed.h in single precision. Guarantee: approximate, as there. Text of C++ and
// of GLSL, GLSL ES 3.0 included; who includes it has defined what cell_surface.glsl.h asks for.
#ifndef SCARP_MARCH_RELAXED_GLSL_H
#define SCARP_MARCH_RELAXED_GLSL_H

#include "scarp/march/height/height_probe.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// RelaxedSettings of march_settings.h.
struct ScarpRelaxed {
  float step_factor;  ///< of the vertical distance h, > 0
  float tolerance;    ///< height off the ground, above or below, that is a hit, per unit of distance, > 0
  int max_steps;      ///< points that are looked at, >= 1; more: kScarpExhausted
};

/// The time of the first point that the march looks at: a step off the surface.
SCARP_FN float scarp_relaxed_begin(ScarpRay ray) { return (ray.flags & kScarpOnSurface) != 0u ? ray.cell_time : 0.0f; }

/// On from time s, for some turns. False: it is not done. Hosts whose drivers limit the turns of loops interrupt it so
/// and go on with the same s and hit.
SCARP_FN bool scarp_relaxed_on(ScarpField field, ScarpRay ray, ScarpRelaxed settings, int turns, SCARP_INOUT(float) s,
                               SCARP_INOUT(ScarpHit) hit) {
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
    if (!point.valid) {
      s += ray.cell_time;
    } else if (abs(h) < settings.tolerance * (s + ray.travelled)) {
      scarp_tell_point(point, s, kScarpHit, hit);
      return true;
    } else if (h < 0.0f && hit.steps == 1u) {
      // Below at the first look: the way back would leave the ray's range.
      if ((ray.flags & kScarpOnSurface) != 0u)
        scarp_tell_point(point, s, kScarpHit, hit);
      else
        hit.status = kScarpBelow;
      return true;
    } else {
      s = max(s + settings.step_factor * h, 0.0f);
    }
  }
  return false;
}

/// A ray of scarp_ray(), scarp_ray_from() or sampled_device_ray() (device_ray.h), to its exit: a point within the
/// tolerance of the ground, to which the march also comes back from below. The answer's time counts from the ray's
/// begin. Perhaps not the first such place.
SCARP_FN ScarpHit scarp_relaxed(ScarpField field, ScarpRay ray, ScarpRelaxed settings) {
  ScarpHit hit = scarp_no_hit();
  float s = scarp_relaxed_begin(ray);
  while (!scarp_relaxed_on(field, ray, settings, kScarpAllTurns, s, hit)) {
  }
  return hit;
}

SCARP_GLSL_END

#endif
