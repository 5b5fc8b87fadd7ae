// SPDX-License-Identifier: MIT
// `fixed-step` for shaders: the march of fixed_step.h in single precision. Guarantee: approximate, as there. Text of
// C++ and of GLSL, GLSL ES 3.0 included; who includes it has defined what cell_surface.glsl.h asks for.
#ifndef SCARP_MARCH_FIXED_STEP_GLSL_H
#define SCARP_MARCH_FIXED_STEP_GLSL_H

#include "scarp/march/height/height_probe.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// FixedStepSettings of march_settings.h.
struct ScarpFixedStep {
  float step;       ///< cells, their shorter side (ScarpRay::cell_time), > 0
  int interpolate;  ///< 0: a hit is put on the first point that is not above; 1: between it and the point before
  int max_steps;    ///< points that are looked at, >= 1; more: kScarpExhausted
};

/// Where the march stands.
struct ScarpSteps {
  int next;                ///< the point to be looked at
  int above;               ///< 1: the last point over ground was above it
  int known;               ///< 1: the point before was over ground
  float s_before;          ///< time of the last point
  float clearance_before;  ///< sample units that the ray was above the ground there; 0 over a hole
};
/// Where the march of a ray begins: at its first point, or at the second from the surface.
SCARP_FN ScarpSteps scarp_first_step(ScarpRay ray) {
  ScarpSteps steps;
  steps.above = (ray.flags & kScarpOnSurface) != 0u ? 1 : 0;
  steps.known = steps.above;
  steps.next = steps.above;
  steps.s_before = 0.0f;
  steps.clearance_before = 0.0f;
  return steps;
}

/// On from where the march stands, for some turns. False: it is not done. Hosts whose drivers limit the turns of loops
/// interrupt it so and go on with the same steps and hit.
SCARP_FN bool scarp_step_on(ScarpField field, ScarpRay ray, ScarpFixedStep settings, int turns,
                            SCARP_INOUT(ScarpSteps) steps, SCARP_INOUT(ScarpHit) hit) {
  bool on_surface = (ray.flags & kScarpOnSurface) != 0u;
  float step = settings.step * ray.cell_time;
  for (int turn = 0; turn < turns; ++turn) {
    if (steps.next == settings.max_steps) {
      scarp_give_up(steps.s_before, hit);
      return true;
    }
    // Counted, not summed up; the last sample is where the ray ends.
    float s = min(float(steps.next) * step, ray.exit);
    hit.steps += 1u;
    hit.fetches += 4u;
    ScarpPoint point = scarp_point(field, ray, s);
    if (!point.valid) {
      steps.known = 0;
    } else if (point.clearance > 0.0f || (on_surface && point.clearance == 0.0f)) {
      steps.above = 1;
      steps.known = 1;
    } else if (steps.known != 0 && steps.above != 0) {
      if (settings.interpolate != 0 && !(steps.clearance_before == 0.0f)) {
        float share = steps.clearance_before / (steps.clearance_before - point.clearance);
        float s_between = steps.s_before + (s - steps.s_before) * share;
        ScarpPoint between = scarp_point(field, ray, s_between);
        hit.fetches += 4u;
        if (between.valid) {
          scarp_tell_point(between, s_between, kScarpHit, hit);
          return true;
        }
      }
      scarp_tell_point(point, s, kScarpHit, hit);
      return true;
    } else if (steps.known == 0 && point.clearance == 0.0f) {
      scarp_tell_point(point, s, kScarpHit, hit);
      return true;
    } else {
      bool from_outside = hit.steps > 1u || (ray.flags & kScarpFromOutside) != 0u;
      if (steps.known == 0 && (field.flags & kScarpSolid) != 0u && from_outside) {
        scarp_tell_point(point, s, kScarpWall, hit);
        return true;
      }
      if (hit.steps == 1u) hit.status = kScarpBelow;
      steps.above = 0;
      steps.known = 1;
    }
    steps.s_before = s;
    steps.clearance_before = point.clearance;
    if (!(s < ray.exit)) return true;
    steps.next += 1;
  }
  return false;
}

/// A ray of scarp_ray(), scarp_ray_from() or sampled_device_ray() (device_ray.h), to its exit: the first point that is
/// on or below the ground after one that was above, or between the two. The answer's time counts from the ray's begin.
/// Passes over what is thinner than a step; the points are those of the march in double.
SCARP_FN ScarpHit scarp_fixed_step(ScarpField field, ScarpRay ray, ScarpFixedStep settings) {
  ScarpHit hit = scarp_no_hit();
  ScarpSteps steps = scarp_first_step(ray);
  while (!scarp_step_on(field, ray, settings, kScarpAllTurns, steps, hit)) {
  }
  return hit;
}

SCARP_GLSL_END

#endif
