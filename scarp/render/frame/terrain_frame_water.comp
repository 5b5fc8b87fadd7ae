// SPDX-License-Identifier: MIT
// Determines whether pixels show water or ground, and the rays that continue from water: a stage of
// terrain_frame.glsl.h.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/render/frame/terrain_frame_stage.glsl.h"
// The following files use its definitions of ground and directions.
#include "scarp/march/height/cell_surface.glsl.h"
#include "scarp/render/frame/terrain_frame_meet_water.glsl.h"
#include "scarp/render/frame/terrain_frame_place.glsl.h"
#include "scarp/render/frame/terrain_frame_plinth.glsl.h"
#include "scarp/render/frame/terrain_frame_send.glsl.h"

// Unit normal of the water with its waves.
vec3 water_normal(ScarpPaintPlace place, float footprint) {
  Settings s = settings();
  vec2 tilt = vec2(0.0);
  if (s.is.waves == 0.0) return vec3(0.0, 0.0, 1.0);
  for (int i = 0; i < kScarpWaves; ++i) {
    FrameWave wave = s.is.wave[i];
    float seen = scarp_wave_seen(wave.metres, footprint);
    if (seen == 0.0) break;
    ScarpTwoFloat turns = weighed(place, wave.turns, wave.turns_low);
    tilt += seen * scarp_wave_slope(i, (turns.high - floor(turns.high)) + turns.low, s.is.waves) * wave.along;
  }
  return normalize(vec3(-tilt.x, -tilt.y, 1.0));
}

// Mean square of the wave slopes that water_normal() omits.
float water_roughness(float footprint) {
  Settings s = settings();
  float roughness = 0.0;
  for (int i = 0; i < kScarpWaves; ++i)
    roughness += scarp_wave_roughness(scarp_wave_seen(s.is.wave[i].metres, footprint), s.is.waves);
  return roughness;
}

// Distance in metres after which a ray in the water leaves through a side of the field; kScarpNever if it does not.
float leaves_water(ScarpField field, ScarpLine line) {
  if ((field.flags & kScarpWraps) != 0u) return kScarpNever;
  return min(scarp_span_x(field, line).end.high, scarp_span_y(field, line).end.high);
}

// Decides between water and the hit of the camera ray.
void decide(ScarpField field, inout FrameSeen camera, inout FrameWater water) {
  // Exact rays end at the water. At a sample, ground is tested before water; between samples, the nearer one counts.
  if (camera.kind != kFrameNothing && water.kind != 0) {
    if (stepped && settings().is.interpolate != 0 && water.t.high < camera.t.high)
      camera.kind = kFrameNothing;
    else
      water.kind = 0;
  }
  if (camera.kind == kFrameGround && is_sea(field, camera.cell)) {
    water.kind = 1;
    water.t = camera.t;
    water.sea = 1;
    water.cell = camera.cell;
    water.place = camera.place;
    water.normal = vec3(0.0, 0.0, 1.0);
  }
}

// Sends one of the rays that continue from the water, if it has anything to march.
void send_from(ScarpField field, FrameWater water, uint i, inout FrameSeen seen) {
  ScarpTwoFloat end = seen.end;
  float step = 0.0;
  uint how = stepped ? kScarpSendSampled : 0u;
  if (stepped) {
    step = step_of(seen, false);
    end = scarp_two(stepped_end(field, seen, step));
  }
  bool goes = !(end.high < 0.0);
  if (has_rims) end_at_base(seen.line, end);
  if (water.sea != 0) how |= kScarpSendFromSurface;
  ScarpField met = walled(field);
  ScarpSent sent = scarp_send(met, seen.line, scarp_two(0.0), end, how, water.cell, water.place);
  if (seen.asked == 0 || !goes || sent.marches == 0) return;
  if (!meets_walls(met, sent.ray)) sent.ray.flags |= kScarpThroughWalls;
  seen.t = sent.begin;
  seen.per_time = sent.per_time;
  list_ray(sent, step, i);
}

// The mirrored ray, and the one to the bottom.
void send_on(ScarpField field, uint slot, FrameSeen camera, inout FrameWater water) {
  Settings s = settings();
  vec3 direction = direction_of(camera.line);
  float metres = water.t.high * camera.metres;
  ScarpTwoFloat x = scarp_line_col(camera.line, water.t);
  ScarpTwoFloat y = scarp_line_row(camera.line, water.t);
  ScarpTwoFloat z = scarp_line_height(camera.line, water.t);
  vec3 normal = water.normal;
  float roughness = 0.0;
  if (normal.z > 0.0) {
    // At a grazing angle, the footprint of a pixel on the water is longer than wide.
    float wide = s.is.pixel_width * (s.is.orthographic != 0 ? 1.0 : metres);
    float footprint = wide / sqrt(max(-direction.z, 0.01));
    normal = water_normal(paint_place(camera.line, water.t), footprint);
    if (has_scattering) roughness = water_roughness(footprint);
    if (dot(normal, direction) >= 0.0) normal = vec3(0.0, 0.0, 1.0);
  }
  water.reflectance = scarp_schlick(-dot(normal, direction), 1.333);
  if (has_scattering && water.normal.z > 0.0)
    water.glitter = scarp_glitter(s.is.sky, s.is.sun, direction, normal, roughness, water.reflectance);
  vec3 mirrored = scarp_reflected(direction, normal);
  if (water.normal.z > 0.0) mirrored = scarp_kept_above(mirrored);
  vec3 refracted = scarp_refracted(direction, normal, 1.333);
  FrameSeen seen = camera;
  seen.line.origin = vec3(x.high, y.high, z.high);
  seen.line.origin_low = vec3(x.low, y.low, z.low);
  seen.line.direction_low = vec3(0.0);
  seen.metres = 1.0;
  seen.kind = kFrameNothing;
  seen.steps = 0u;
  // A single call that sends rays keeps the shader small.
  for (int ray = kFrameMirror; ray <= kFrameBottom; ++ray) {
    bool mirror = ray == kFrameMirror;
    seen.line.direction = grid_direction(mirror ? mirrored : refracted);
    seen.end = scarp_two(mirror ? s.is.reach : min(s.is.reach, leaves_water(field, seen.line)));
    seen.asked = mirror ? s.is.reflection : water.sea != 0 ? 0 : s.is.refraction;
    uint i = seen_index(ray, slot);
    seen.t = scarp_two(kScarpNever);
    send_from(field, water, i, seen);
    keep(i, seen);
    Seens(push.seens).of[i].asked = seen.asked;
    Seens(push.seens).of[i].end = seen.end;
  }
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= push.threads) return;
  ScarpField field = shown_field();
  FrameSeen camera = Seens(push.seens).of[slot];
  FrameWater water = Waters(push.waters).of[slot];
  decide(field, camera, water);
  Seens(push.seens).of[slot].kind = camera.kind;
  if (water.kind != 0) {
    if (settings().is.iterations == 0) send_on(field, slot, camera, water);
  } else if (camera.kind == kFrameGround) {
    list_ground(slot);
  }
  Waters(push.waters).of[slot] = water;
}
