// SPDX-License-Identifier: MIT
// The camera rays, one per pixel, and where they would reach the water: a stage of terrain_frame.glsl.h.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/render/frame/terrain_frame_stage.glsl.h"
// The following files use its definitions of ground and directions.
#include "scarp/march/height/cell_surface.glsl.h"
#include "scarp/render/frame/terrain_frame_meet_water.glsl.h"
#include "scarp/render/frame/terrain_frame_plinth.glsl.h"
#include "scarp/render/frame/terrain_frame_send.glsl.h"

ScarpTwoFloat camera_number(float base, float base_low, float right, float right_low, float down, float down_low,
                            vec2 at) {
  return scarp_two_combine(two(right, right_low), scarp_two(at.x), two(down, down_low), scarp_two(at.y),
                           two(base, base_low));
}

// The camera ray through a position in the picture, in pixels.
FrameSeen camera_ray(vec2 at) {
  Settings s = settings();
  ScarpLine base = s.is.line;
  ScarpLine right = s.is.line_right;
  ScarpLine down = s.is.line_down;
  FrameSeen seen;
  for (int i = 0; i < 3; ++i) {
    ScarpTwoFloat d = camera_number(base.direction[i], base.direction_low[i], right.direction[i],
                                    right.direction_low[i], down.direction[i], down.direction_low[i], at);
    seen.line.direction[i] = d.high;
    seen.line.direction_low[i] = d.low;
    ScarpTwoFloat o = two(base.origin[i], base.origin_low[i]);
    if (s.is.orthographic != 0)
      o = camera_number(base.origin[i], base.origin_low[i], right.origin[i], right.origin_low[i], down.origin[i],
                        down.origin_low[i], at);
    seen.line.origin[i] = o.high;
    seen.line.origin_low[i] = o.low;
  }
  seen.metres = length(world_direction(seen.line.direction));
  seen.kind = kFrameNothing;
  seen.t = scarp_two(kScarpNever);
  seen.per_time = 1.0;
  seen.end = scarp_two(s.is.reach / seen.metres);
  seen.cell = ivec2(0);
  seen.place = vec2(0.0);
  seen.steps = 0u;
  return seen;
}

// The step at which a stepped ray detects that it has reached the water at time `plane`.
float stop_of(ScarpField field, FrameSeen seen, float step, float plane) {
  float first = 0.0;
  if ((field.flags & kScarpWraps) == 0u) {
    // A ray along an axis has an infinite span.
    first = max(0.0, max(scarp_span_x(field, seen.line).begin.high, scarp_span_y(field, seen.line).begin.high));
  }
  return first + ceil((plane - first) / step) * step;
}

// End of a stepped ray. Water that it does not reach is ignored. Less than 0: no ray.
float end_of_steps(ScarpField field, float step, inout FrameSeen seen, inout FrameWater water) {
  float last = stepped_end(field, seen, step);
  if (last < 0.0) {
    seen.steps = 1u;
    water.kind = 0;
  } else if (water.kind != 0) {
    // The water is detected at the first step past it, if the ray gets that far.
    float stop = stop_of(field, seen, step, water.t.high);
    if (stop > last) water.kind = 0;
    last = min(last, stop);
    if (settings().is.interpolate == 0) water.t = scarp_two(stop);
    // The side of the water and its bottom are not needed.
    water.sea = 0;
    water.normal = vec3(0.0, 0.0, 1.0);
  }
  return last;
}

// Limits the range of an exact ray to where it may hit ground. Returns false if it cannot.
bool limit(ScarpField field, inout ScarpTwoFloat begin, inout ScarpTwoFloat end, inout FrameSeen seen,
           inout FrameWater water) {
  ScarpLine line = seen.line;
  // There is nothing to hit above the highest ground.
  if (line.direction.z > 0.0) {
    float leaves = (field.highest - line.origin.z) / line.direction.z;
    end = scarp_two_earlier(end, scarp_two(max(0.0, leaves)));
    if (scarp_two_less(end, water.t)) water.kind = 0;
  }
  if (water.kind != 0) end = water.t;
  bool hidden = has_plinth && hidden_by_plinth(field, begin, end, seen);
  if (seen.kind == kFrameWall) water.kind = 0;
  return !hidden;
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= push.threads) return;
  Settings s = settings();
  ScarpField field = shown_field();
  uint pixel = push.first + slot;
  int aa = s.is.aa;
  vec2 at = vec2(float(pixel % uint(s.is.width)), float(pixel / uint(s.is.width))) +
            (vec2(float(push.point % aa), float(push.point / aa)) + 0.5) / float(aa);
  FrameSeen seen = camera_ray(at);
  FrameWater water = water_on(field, seen.line, seen.end);
  ScarpTwoFloat begin = scarp_two(0.0);
  ScarpTwoFloat end = seen.end;
  float step = 0.0;
  bool goes;
  if (stepped) {
    step = step_of(seen, true);
    end = scarp_two(end_of_steps(field, step, seen, water));
    goes = !(end.high < 0.0);
  } else {
    goes = limit(field, begin, end, seen, water);
  }
  ScarpField met = walled(field);
  ScarpSent sent = scarp_send(met, seen.line, begin, end, stepped ? kScarpSendSampled : 0u, seen.cell, seen.place);
  if (goes && sent.marches != 0) {
    if (!meets_walls(met, sent.ray)) sent.ray.flags |= kScarpThroughWalls;
    seen.t = sent.begin;
    seen.per_time = sent.per_time;
    list_ray(sent, step, slot);
  }
  keep(slot, seen);
  if (seen.kind == kFrameWall) {
    Seens(push.seens).of[slot].cell = seen.cell;
    Seens(push.seens).of[slot].place = seen.place;
  }
  if (has_water) Waters(push.waters).of[slot] = water;
}
