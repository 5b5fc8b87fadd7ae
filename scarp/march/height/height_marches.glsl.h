// SPDX-License-Identifier: MIT
// `naive`, `fixed-step`, `relaxed` and `lipschitz` over height fields, for shaders: the turns of naive.glsl.h and so
// on, driven by the probe of height_probe.glsl.h.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0. The including file must define the functions that
// cell_surface.glsl.h requires, and scarp_minimum of max_mip.glsl.h, which only `lipschitz` over fields with holes
// calls.
#ifndef SCARP_MARCH_HEIGHT_MARCHES_GLSL_H
#define SCARP_MARCH_HEIGHT_MARCHES_GLSL_H

#include "scarp/march/height/height_probe.glsl.h"
#include "scarp/march/sampling/sampling_marches.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// A ray over a height field. Clearances are in sample units.
SCARP_FN ScarpWay scarp_way(ScarpField field, ScarpRay ray, ScarpSampling settings) {
  ScarpWay way;
  way.exit = ray.exit;
  way.last = min(ray.exit, ray.end);
  way.travelled = ray.travelled;
  way.per_clearance = ray.per_height;
  way.rounding = 0.0f;
  way.blind = ray.cell_time;
  way.stride = settings.factor * ray.cell_time;
  way.from_surface = (ray.flags & kScarpOnSurface) != 0u;
  way.from_outside = (ray.flags & kScarpFromOutside) != 0u;
  way.solid = (field.flags & kScarpSolid) != 0u;
  return way;
}

/// The state before the first point of a ray.
SCARP_FN ScarpMarchState scarp_sampled_begin(ScarpField field, ScarpRay ray, ScarpSampling settings) {
  return scarp_sampling_begin(scarp_way(field, ray, settings), settings);
}

/// Sets the result: a status at a point and its time.
SCARP_FN void scarp_tell_point(ScarpPoint point, float s, int status, SCARP_INOUT(ScarpHit) hit) {
  hit.status = status;
  hit.cell = point.cell;
  hit.place = point.place;
  hit.time = s;
  hit.time_low = 0.0f;
}

/// Sets the result to the hit at `last`, the point at state.s, refined.
SCARP_FN void scarp_tell_refined(ScarpField field, ScarpRay ray, ScarpWay way, ScarpSampling settings, ScarpPoint last,
                                 ScarpMarchState state, SCARP_INOUT(ScarpHit) hit) {
  float from = state.before;
  float to = state.s;
  if (settings.refinement == kScarpRefineBisect) {
    for (int i = 0; i < settings.halvings; ++i) {
      float s = 0.5f * (from + to);
      hit.steps += 1u;
      hit.fetches += 4u;
      ScarpPoint middle = scarp_point(field, ray, s);
      if (middle.valid && scarp_sampling_stops(way, settings, s, middle.clearance))
        to = s;
      else
        from = s;
    }
  } else {
    to = scarp_sampling_secant(way, settings, last.clearance, state);
  }
  ScarpPoint point = scarp_point(field, ray, to);
  hit.fetches += 4u;
  if (point.valid)
    scarp_tell_point(point, to, kScarpHit, hit);
  else
    scarp_tell_point(last, state.s, kScarpHit, hit);
}

/// Continues a march for at most `turns` turns of its loop, at least one step. Returns whether it is done; otherwise
/// call again with the same state and hit. For drivers that limit loops. A step counts twice: compilers turn an inlined
/// function that returns early into a loop of one turn, which drivers count. Over holes a step of lipschitz counts all
/// levels that it may climb: invocations in a vector wait for one another, whichever climbs.
SCARP_FN bool scarp_sampled_on(ScarpField field, ScarpRay ray, ScarpSampling settings, int turns,
                               SCARP_INOUT(ScarpMarchState) state, SCARP_INOUT(ScarpHit) hit) {
  ScarpWay way = scarp_way(field, ray, settings);
  bool climbs = settings.march == kScarpLipschitz && (field.flags & kScarpHoles) != 0u;
  int turns_of_step = climbs ? 2 + 2 * field.top_level : 2;
  for (int turn = 0; turn < turns; turn += turns_of_step) {
    if (!(state.s <= way.last)) {
      hit.status = scarp_sampling_missed(state);
      return true;
    }
    if (state.steps == settings.max_steps) {
      hit.status = kScarpExhausted;
      hit.time = scarp_sampling_reached(settings, state);
      hit.time_low = 0.0f;
      return true;
    }
    hit.steps += 1u;
    hit.fetches += 4u;
    ScarpPoint point = scarp_point(field, ray, state.s);
    float until = climbs ? scarp_bounded_until(field, ray, point, state.s, hit.fetches) : kScarpNever;
    int status = scarp_sampling_turn(way, settings, point.valid, point.clearance, until, state);
    if (status == kScarpMiss) continue;
    if (status == kScarpHit && scarp_sampling_refines(settings, state))
      scarp_tell_refined(field, ray, way, settings, point, state, hit);
    else
      scarp_tell_point(point, state.s, status, hit);
    return true;
  }
  return false;
}

/// Returns the first hit of a ray of scarp_ray(), scarp_ray_from() or sampled_device_ray() (device_ray.h). Its time
/// counts from the start of the ray.
SCARP_FN ScarpHit scarp_sampled(ScarpField field, ScarpRay ray, ScarpSampling settings) {
  ScarpHit hit = scarp_no_hit();
  ScarpMarchState state = scarp_sampled_begin(field, ray, settings);
  while (!scarp_sampled_on(field, ray, settings, kScarpAllTurns, state, hit)) {
  }
  return hit;
}

SCARP_GLSL_END

#endif
