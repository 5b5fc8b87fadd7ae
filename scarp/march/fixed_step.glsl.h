// SPDX-License-Identifier: MIT
// `fixed-step` for shaders: the march of fixed_step.h in single precision. Guarantee: approximate, as there. Text of
// C++ and of GLSL, GLSL ES 3.0 included; who includes it has defined what cell_surface.glsl.h asks for.
#ifndef SCARP_MARCH_FIXED_STEP_GLSL_H
#define SCARP_MARCH_FIXED_STEP_GLSL_H

#include "scarp/march/ground.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// FixedStepSettings of marches.h.
struct ScarpFixedStep {
  float step;       ///< in cells
  int interpolate;  ///< 0: the first sample that is not above
  int max_steps;
};

/// What the march finds first.
SCARP_FN ScarpHit scarp_fixed_step(ScarpField field, ScarpRay ray, ScarpFixedStep settings) {
  ScarpHit hit = scarp_no_hit();
  bool on_surface = (ray.flags & kScarpOnSurface) != 0u;
  bool above = on_surface;
  bool known = on_surface;  // whether the sample before was over ground
  float s_before = 0.0f;
  float clearance_before = 0.0f;
  float step = settings.step * ray.cell_time;
  for (int i = on_surface ? 1 : 0;; ++i) {
    if (i == settings.max_steps) {
      scarp_give_up(s_before, hit);
      return hit;
    }
    // Counted, not summed up; the last sample is where the ray ends.
    float s = min(float(i) * step, ray.exit);
    hit.steps += 1u;
    hit.fetches += 4u;
    ScarpPoint point = scarp_point(field, ray, s);
    if (!point.valid) {
      known = false;
    } else if (point.clearance > 0.0f || (on_surface && point.clearance == 0.0f)) {
      above = true;
      known = true;
    } else if (known && above) {
      if (settings.interpolate != 0 && !(clearance_before == 0.0f)) {
        float s_between = s_before + (s - s_before) * (clearance_before / (clearance_before - point.clearance));
        ScarpPoint between = scarp_point(field, ray, s_between);
        hit.fetches += 4u;
        if (between.valid) {
          scarp_tell_point(between, s_between, kScarpHit, hit);
          return hit;
        }
      }
      scarp_tell_point(point, s, kScarpHit, hit);
      return hit;
    } else if (!known && point.clearance == 0.0f) {
      scarp_tell_point(point, s, kScarpHit, hit);
      return hit;
    } else {
      if (!known && (field.flags & kScarpSolid) != 0u && (hit.steps > 1u || (ray.flags & kScarpFromOutside) != 0u)) {
        scarp_tell_point(point, s, kScarpWall, hit);
        return hit;
      }
      if (hit.steps == 1u) hit.status = kScarpBelow;
      above = false;
      known = true;
    }
    s_before = s;
    clearance_before = point.clearance;
    if (!(s < ray.exit)) return hit;
  }
  return hit;
}

SCARP_GLSL_END

#endif
