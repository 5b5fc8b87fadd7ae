// SPDX-License-Identifier: MIT
// Pictures of height fields with water, air and light: the looks `comanche` and `shaded`, one invocation per pixel. See
// terrain_frame.glsl.h; what is done for a point is LakeTile's (lake_tile.h), in single precision.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/accel/ground_buffers.glsl.h"
#include "scarp/march/noise.glsl.h"

// Defined below: the marches ask for their ground.
float scarp_sample(int col, int row);
bool scarp_is_nodata(float value);
float scarp_maximum(int level, int col, int row);
float scarp_minimum(int level, int col, int row);

#include "scarp/march/surface_normal.glsl.h"
#include "scarp/render/terrain_frame.glsl.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const bool stepped = false;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Pixels { uint words[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer States { FrameState states[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Sights { FrameSight sights[]; };
layout(push_constant, scalar) uniform Push { FramePush push; };

Ground scarp_ground() { return Ground(push.ground); }

#include "scarp/march/ground_host.glsl.h"
#include "scarp/render/terrain_frame_ground.glsl.h"
#include "scarp/render/terrain_frame_water.glsl.h"

float eye_height(FrameSeen seen) { return height_of(seen.line.origin.z); }
vec3 direction_of(FrameSeen seen) { return normalize(world_direction(seen.line.direction)); }

vec3 in_air(vec3 colour, FrameSeen seen, vec3 direction, float metres) {
  Settings s = settings();
  if (s.is.fog == kScarpNoFog) {
    float clear = exp(-s.is.haze_per_metre * max(0.0, metres - s.is.clear_distance));
    return colour * clear + kScarpHorizon * (1.0 - clear);
  }
  if (s.is.fog == kScarpFogByIterations) return colour;
  float left = scarp_fog_transmittance(s.is.fog, s.is.fog_per_metre, s.is.fog_base, s.is.fog_falloff, eye_height(seen),
                                       direction.z, metres);
  return scarp_between(scarp_fog_colour(dot(direction, s.is.to_sun), s.is.sun_tint), colour, left);
}

// Of what is not ground.
vec3 beside_ground(FrameSeen seen, vec3 direction) {
  Settings s = settings();
  if (seen.kind == kFrameWall) {
    // It stands on the side of its cell through which the ray came in.
    float from_x = direction.x > 0.0 ? seen.place.x : 1.0 - seen.place.x;
    float from_y = direction.y > 0.0 ? 1.0 - seen.place.y : seen.place.y;
    bool on_x = direction.y == 0.0 || (direction.x != 0.0 && from_x <= from_y);
    vec3 normal = on_x ? vec3(direction.x > 0.0 ? -1.0 : 1.0, 0.0, 0.0) : vec3(0.0, direction.y > 0.0 ? -1.0 : 1.0, 0.0);
    float lit = max(0.0, dot(normal, s.is.to_sun));
    return in_air(s.is.earth * (s.is.unlit_wall + (1.0 - s.is.unlit_wall) * lit), seen, direction,
                  seen.t.high * seen.metres);
  }
  vec3 sky = scarp_sky_colour(s.is.no_descent != 0 ? max(0.0, direction.z) : direction.z);
  if (s.is.fog == kScarpNoFog || s.is.fog == kScarpFogByIterations) return sky;
  float left = scarp_fog_transmittance_of_sky(s.is.fog, s.is.fog_per_metre, s.is.fog_base, s.is.fog_falloff,
                                              eye_height(seen), direction.z);
  return scarp_between(scarp_fog_colour(dot(direction, s.is.to_sun), s.is.sun_tint), sky, left);
}

vec3 shading_normal(ScarpField field, FrameSeen seen) {
  return normal_of(scarp_shading_slope(field, seen.cell, seen.place));
}

// Ground in its light, without air.
vec3 lit_ground(ScarpField field, FrameSeen seen) {
  Settings s = settings();
  vec3 normal = shading_normal(field, seen);
  return ground_colour(field, seen, direction_of(seen), normal) *
         scarp_light(normal, s.is.sky_side, s.is.sun, seen.sun_cosine, 1.0);
}

vec3 seen_colour(FrameSeen seen) {
  vec3 direction = direction_of(seen);
  if (seen.kind != kFrameGround) return beside_ground(seen, direction);
  return in_air(seen.light, seen, direction, seen.t.high * seen.metres);
}

ScarpTwoFloat camera_number(float base, float base_low, float right, float right_low, float down, float down_low,
                            vec2 at) {
  return scarp_two_combine(two(right, right_low), scarp_two(at.x), two(down, down_low), scarp_two(at.y),
                           two(base, base_low));
}

// The camera's ray through a place in the picture, in pixels.
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
  seen.end = scarp_two(s.is.reach / seen.metres);
  return seen;
}

FrameSeen no_sight() {
  FrameSeen seen;
  seen.line = ScarpLine(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  seen.metres = 1.0;
  seen.asked = 0;
  seen.kind = kFrameNothing;
  seen.t = scarp_two(kScarpNever);
  seen.end = scarp_two(0.0);
  seen.cell = ivec2(0);
  seen.place = vec2(0.0);
  seen.sun_cosine = 0.0;
  seen.light = vec3(0.0);
  seen.steps = 0u;
  return seen;
}

// Time between two samples of a stepped ray.
float step_of(FrameSeen seen, bool of_camera) {
  Settings s = settings();
  float step = s.is.step / (of_camera && s.is.shells == 0 ? 1.0 : seen.metres);
  if (s.is.step_by_view == 0) return step;
  vec3 direction = direction_of(seen);
  return step / max(length(direction.xy), 0.125);
}

ScarpFixedStep step_settings(FrameState state) {
  Settings s = settings();
  if (state.task >= kFrameSeens) return ScarpFixedStep(s.is.sun_step, s.is.sun_interpolate, s.is.sun_steps);
  return ScarpFixedStep(step_of(state.seen[state.task], state.task == kFrameCamera), s.is.interpolate, s.is.steps + 1);
}

// How far a stepped ray goes, in its time; of the camera's, where it meets the water. Less than 0: nowhere.
float stepped_end(ScarpField field, inout FrameState state) {
  FrameSeen seen = state.seen[state.task];
  bool of_camera = state.task == kFrameCamera;
  float step = step_of(seen, of_camera);
  float end = min(seen.end.high, step * float(settings().is.steps));
  if (seen.line.direction.z > 0.0) {
    float leaves =
        ((field.highest - seen.line.origin.z) - seen.line.origin_low.z) / seen.line.direction.z;
    if (leaves < 0.0) return -1.0;
    end = min(end, leaves + step);
  }
  state.plane = kScarpNever;
  state.stop = kScarpNever;
  if (!of_camera) return end;
  FrameWater water = water_on(field, seen.line, seen.end);
  if (water.kind == 0) return end;
  float first = 0.0;
  if ((field.flags & kScarpWraps) == 0u) {
    // Of a ray along an axis the span is endless.
    first = max(0.0, max(scarp_span_x(field, seen.line).begin.high, scarp_span_y(field, seen.line).begin.high));
  }
  state.plane = water.t.high;
  state.stop = first + ceil((state.plane - first) / step) * step;
  return min(end, state.stop);
}

// Sends the ray of the task; false: there is none, or nothing is on its way.
bool send(ScarpField field, inout FrameState state) {
  Settings s = settings();
  ScarpLine line;
  ScarpTwoFloat end;
  uint how = stepped ? kScarpSendSampled : 0u;
  ivec2 cell = ivec2(0);
  vec2 place = vec2(0.0);
  state.hit = scarp_no_hit();
  if (state.task < kFrameSeens) {
    FrameSeen seen = state.seen[state.task];
    if (seen.asked == 0) return false;
    line = seen.line;
    end = seen.end;
    if (stepped) {
      state.last = stepped_end(field, state);
      if (state.last < 0.0) {
        state.hit.steps = 1u;
        return false;
      }
      end = scarp_two(state.last);
    } else if (state.task == kFrameCamera) {
      // Above the highest ground there is nothing more to meet.
      if (line.direction.z > 0.0) {
        float leaves = (field.highest - line.origin.z) / line.direction.z;
        end = scarp_two_earlier(end, scarp_two(max(0.0, leaves)));
      }
      state.water = water_on(field, line, end);
      if (state.water.kind != 0) end = state.water.t;
    }
    if (state.task != kFrameCamera && state.water.sea != 0) {
      how |= kScarpSendFromSurface;
      cell = state.water.cell;
      place = state.water.place;
    }
  } else {
    FrameSeen seen = state.seen[state.task - kFrameSeens];
    if (seen.kind != kFrameGround) return false;
    float cosine = dot(shading_normal(field, seen), s.is.to_sun);
    state.seen[state.task - kFrameSeens].sun_cosine = max(0.0, cosine);
    if (s.is.shadows == 0 || !(cosine > 0.0)) return false;
    ScarpTwoFloat x = scarp_line_col(seen.line, seen.t);
    ScarpTwoFloat y = scarp_line_row(seen.line, seen.t);
    ScarpTwoFloat z = scarp_line_height(seen.line, seen.t);
    line = ScarpLine(vec3(x.high, y.high, z.high), vec3(x.low, y.low, z.low), s.is.sun_line, s.is.sun_line_low);
    end = scarp_two(kScarpNever);
    // Rays over endless ground need an end: above the highest summit nothing is met, and low rays end far away.
    if ((field.flags & kScarpWraps) != 0u)
      end = scarp_two(max((field.highest - z.high) * s.is.metres_per_sample, 0.0) / max(s.is.to_sun.z, 1e-3));
    how |= kScarpSendFromSurface;
    cell = seen.cell;
    place = seen.place;
  }
  state.sent = scarp_send(field, line, end, how, cell, place);
  if (state.sent.marches == 0) return false;
  if (stepped) {
    state.steps = scarp_first_step(state.sent.ray);
    return true;
  }
  return scarp_begin_walk(field, state.sent.ray, state.walk, state.hit);
}

bool any_of(FrameState state) { return state.task >= kFrameSeens; }

// Rays that the water sends on.
void send_from_water(ScarpField field, inout FrameState state) {
  Settings s = settings();
  FrameSeen camera = state.seen[kFrameCamera];
  vec3 direction = direction_of(camera);
  float metres = state.water.t.high * camera.metres;
  ScarpTwoFloat x = scarp_line_col(camera.line, state.water.t);
  ScarpTwoFloat y = scarp_line_row(camera.line, state.water.t);
  ScarpTwoFloat z = scarp_line_height(camera.line, state.water.t);
  vec3 normal = state.water.normal;
  if (normal.z > 0.0) {
    // A pixel is longer on the water than it is wide, seen at a grazing angle.
    float wide = s.is.pixel_width * (s.is.orthographic != 0 ? 1.0 : metres);
    normal = water_normal(paint_place(camera.line, state.water.t), wide / sqrt(max(-direction.z, 0.01)));
    if (dot(normal, direction) >= 0.0) normal = vec3(0.0, 0.0, 1.0);
  }
  state.water.reflectance = scarp_schlick(-dot(normal, direction), 1.333);
  vec3 mirrored = scarp_reflected(direction, normal);
  if (state.water.normal.z > 0.0) mirrored = scarp_kept_above(mirrored);
  FrameSeen sent = no_sight();
  sent.line = ScarpLine(vec3(x.high, y.high, z.high), vec3(x.low, y.low, z.low), grid_direction(mirrored), vec3(0.0));
  sent.end = scarp_two(s.is.reach);
  sent.asked = s.is.reflection;
  state.seen[kFrameMirror] = sent;
  if (s.is.refraction == 0 || state.water.sea != 0) return;
  sent.line.direction = grid_direction(scarp_refracted(direction, normal, 1.333));
  sent.end = scarp_two(min(s.is.reach, leaves_water(field, sent.line)));
  sent.asked = 1;
  state.seen[kFrameBottom] = sent;
}

// What the ray of the task has found.
void take(ScarpField field, inout FrameState state) {
  bool met = state.hit.status == kScarpHit || state.hit.status == kScarpWall;
  if (state.task >= kFrameSeens) {
    FrameSeen lit = state.seen[state.task - kFrameSeens];
    if (lit.kind != kFrameGround) return;
    if (met) lit.sun_cosine = 0.0;
    state.seen[state.task - kFrameSeens].light = lit_ground(field, lit);
    return;
  }
  FrameSeen seen = state.seen[state.task];
  seen.steps = state.hit.steps;
  if (met) {
    seen.kind = state.hit.status == kScarpWall ? kFrameWall : kFrameGround;
    seen.t = scarp_sent_time(state.sent, state.hit);
    seen.cell = state.hit.cell;
    seen.place = state.hit.place;
  }
  if (state.task == kFrameCamera) {
    Settings s = settings();
    if (stepped) {
      seen.steps = min(seen.steps, uint(s.is.steps));
      // Ground is asked for first and water then, at each sample; in between, what comes first counts.
      bool at_water = state.stop <= state.last;
      if (at_water && (!met || (s.is.interpolate != 0 && state.plane < seen.t.high))) {
        state.water.kind = 1;
        state.water.t = scarp_two(s.is.interpolate != 0 ? state.plane : state.stop);
        seen.kind = kFrameNothing;
      }
    } else if (met) {
      state.water.kind = 0;
    }
    if (seen.kind == kFrameGround && s.is.water != 0 && is_sea(field, seen.cell)) {
      state.water.kind = 1;
      state.water.t = seen.t;
      state.water.sea = 1;
      state.water.cell = seen.cell;
      state.water.place = seen.place;
      state.water.normal = vec3(0.0, 0.0, 1.0);
    }
    state.seen[kFrameCamera] = seen;
    if (state.water.kind != 0) send_from_water(field, state);
    return;
  }
  state.seen[state.task] = seen;
}

vec3 water_colour(FrameState state) {
  Settings s = settings();
  vec3 body = s.is.deep;
  FrameSeen bottom = state.seen[kFrameBottom];
  if (bottom.asked != 0) {
    if (bottom.kind != kFrameNothing) {
      float depth = s.is.level - height_of(scarp_line_height(bottom.line, bottom.t).high);
      vec3 sunlight = scarp_left_after(s.is.water_per_metre, scarp_sun_way(depth, s.is.to_sun.z, 1.333));
      body = scarp_through_water(bottom.light * sunlight, s.is.deep, s.is.water_per_metre, bottom.t.high * bottom.metres);
    } else if (bottom.end.high < 0.5 * kScarpNever) {
      body = scarp_through_water(beside_ground(bottom, direction_of(bottom)), s.is.deep, s.is.water_per_metre,
                                 bottom.end.high);
    }
  }
  float mirror = state.water.reflectance;
  return seen_colour(state.seen[kFrameMirror]) * mirror + body * (1.0 - mirror);
}

vec3 colour_of(FrameState state) {
  Settings s = settings();
  FrameSeen camera = state.seen[kFrameCamera];
  float share = min(1.0, float(camera.steps) / float(s.is.most_steps));
  if (s.is.iterations != 0) return vec3(share);
  vec3 direction = direction_of(camera);
  vec3 colour;
  if (state.water.kind != 0)
    colour = in_air(water_colour(state), camera, direction, state.water.t.high * camera.metres);
  else
    colour = seen_colour(camera);
  if (s.is.fog == kScarpFogByIterations)
    colour = scarp_between(colour, scarp_fog_colour(dot(direction, s.is.to_sun), s.is.sun_tint), share);
  return colour;
}

// The next point of a pixel.
void begin_point(uint pixel, inout FrameState state) {
  Settings s = settings();
  int aa = s.is.aa;
  vec2 at = vec2(float(pixel % uint(s.is.width)), float(pixel / uint(s.is.width))) +
            (vec2(float(state.point % aa), float(state.point / aa)) + 0.5) / float(aa);
  FrameSeen camera = no_sight();
  FrameSeen ray = camera_ray(at);
  camera.line = ray.line;
  camera.metres = ray.metres;
  camera.end = ray.end;
  camera.asked = 1;
  state.seen[kFrameCamera] = camera;
  state.seen[kFrameMirror] = no_sight();
  state.seen[kFrameBottom] = no_sight();
  state.water.kind = 0;
  state.water.t = scarp_two(kScarpNever);
  state.water.sea = 0;
  state.water.cell = ivec2(0);
  state.water.place = vec2(0.0);
  state.water.normal = vec3(0.0, 0.0, 1.0);
  state.water.reflectance = 0.0;
  state.plane = kScarpNever;
  state.stop = kScarpNever;
  state.last = 0.0;
  state.task = 0;
  state.under_way = 0;
}

void tell_sight(uint pixel, FrameState state) {
  FrameSeen camera = state.seen[kFrameCamera];
  FrameSight sight;
  sight.kind = state.water.kind != 0 ? kFrameWater : camera.kind;
  sight.t = (state.water.kind != 0 ? state.water.t.high : camera.t.high) * camera.metres;
  sight.cell = camera.cell;
  sight.steps = camera.steps;
  Sights(push.sights).sights[pixel] = sight;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  uint pixel = push.first + i;
  int points = settings().is.aa * settings().is.aa;
  ScarpField field = scarp_ground_field();
  FrameState state;
  if (push.resume != 0u) {
    if (Pixels(push.pixels).words[i] != 0u) return;
    state = States(push.states).states[i];
  } else {
    state.point = 0;
    state.sum = vec3(0.0);
    state.task = -1;
  }
  bool all_done = false;
  for (int round = 0; round < kFrameRounds; ++round) {
    if (state.task < 0) begin_point(pixel, state);
    bool marches = state.under_way != 0 || send(field, state);
    bool done = true;
    if (marches) {
      done = stepped ? scarp_step_on(field, state.sent.ray, step_settings(state), kFrameTurns, state.steps, state.hit)
                     : scarp_go_on(field, state.sent.ray, any_of(state), kFrameTurns, state.walk, state.hit);
    }
    state.under_way = done ? 0 : 1;
    if (!done) break;
    take(field, state);
    state.task += 1;
    if (state.task < kFrameTasks && !(settings().is.iterations != 0)) continue;
    if (state.point == 0 && push.tell_sights != 0u) tell_sight(pixel, state);
    state.sum += colour_of(state);
    state.point += 1;
    if (state.point == points) {
      all_done = true;
      break;
    }
    state.task = -1;
  }
  if (!all_done) {
    States(push.states).states[i] = state;
    Pixels(push.pixels).words[i] = 0u;
    return;
  }
  vec3 colour = state.sum / float(points);
  Pixels(push.pixels).words[i] = uint(scarp_srgb_byte(colour.x)) | (uint(scarp_srgb_byte(colour.y)) << 8) |
                                 (uint(scarp_srgb_byte(colour.z)) << 16) | 0xff000000u;
}
