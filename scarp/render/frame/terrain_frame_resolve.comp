// SPDX-License-Identifier: MIT
// Colours of points, including everything between the eye and the surface, and of pixels: the last stage of
// terrain_frame.glsl.h.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/render/frame/terrain_frame_stage.glsl.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Sums { FrameSum of[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Sights { FrameSight of[]; };

float eye_height(FrameSeen seen) { return height_of(seen.line.origin.z); }

ScarpSky the_sky() {
  ScarpSky sky = settings().is.sky;
  if (!has_scattering) sky.scattering = 0;  // a constant for the compiler
  return sky;
}

vec3 in_air(vec3 colour, FrameSeen seen, vec3 direction, float metres) {
  Settings s = settings();
  if (!has_fog || s.is.fog == kScarpNoFog)
    return scarp_in_haze(colour, the_sky(), direction, s.is.haze_per_metre, metres - s.is.clear_distance);
  if (s.is.fog == kScarpFogByIterations) return colour;
  float left = scarp_fog_transmittance(s.is.fog, s.is.fog_per_metre, s.is.fog_base, s.is.fog_falloff, eye_height(seen),
                                       direction.z, metres);
  return scarp_between(scarp_fog_colour(the_sky(), direction, s.is.sun_tint), colour, left);
}

// Transmittance of the fog for light from beyond the scene.
float left_from_beyond(FrameSeen seen, vec3 direction) {
  Settings s = settings();
  if (!has_fog) return 1.0;
  return scarp_fog_transmittance_of_sky(s.is.fog, s.is.fog_per_metre, s.is.fog_base, s.is.fog_falloff, eye_height(seen),
                                        direction.z);
}

vec3 sky_behind(FrameSeen seen, vec3 direction) {
  Settings s = settings();
  ScarpSky air = the_sky();
  vec3 sky = s.is.no_descent != 0 ? scarp_sky_beyond(air, direction) : scarp_sky_colour(air, direction);
  if (!has_fog || s.is.fog == kScarpNoFog || s.is.fog == kScarpFogByIterations) return sky;
  float left = left_from_beyond(seen, direction);
  return scarp_between(scarp_fog_colour(air, direction, s.is.sun_tint), sky, left);
}

vec3 wall_colour(FrameSeen seen, vec3 direction) {
  Settings s = settings();
  // A wall is on the side of its cell through which the ray entered.
  float from_x = direction.x > 0.0 ? seen.place.x : 1.0 - seen.place.x;
  float from_y = direction.y > 0.0 ? 1.0 - seen.place.y : seen.place.y;
  bool on_x = direction.y == 0.0 || (direction.x != 0.0 && from_x <= from_y);
  vec3 normal = on_x ? vec3(direction.x > 0.0 ? -1.0 : 1.0, 0.0, 0.0) : vec3(0.0, direction.y > 0.0 ? -1.0 : 1.0, 0.0);
  float lit = max(0.0, dot(normal, s.is.to_sun));
  return s.is.earth * (s.is.unlit_wall + (1.0 - s.is.unlit_wall) * lit);
}

// Light that leaves the water at its surface; `behind` is the colour that its ray sees.
vec3 water_body(FrameSeen bottom, vec3 behind) {
  Settings s = settings();
  vec3 light = behind;
  float metres = bottom.end.high;
  if (bottom.kind != kFrameNothing) {
    float depth = s.is.level - height_of(scarp_line_height(bottom.line, bottom.t).high);
    light *= scarp_left_after(s.is.water_per_metre, scarp_sun_way(depth, s.is.to_sun.z, 1.333));
    metres = bottom.t.high * bottom.metres;
  }
  bool ends = bottom.asked != 0 && (bottom.kind != kFrameNothing || bottom.end.high < 0.5 * kScarpNever);
  return ends ? scarp_through_water(light, s.is.deep, s.is.water_per_metre, metres) : s.is.deep;
}

// Colour of the point, seen by the camera. One loop over all rays, from that to the water's bottom through the mirrored
// one to the camera ray, keeps the shader small.
vec3 colour_of_point(uint slot, FrameWater water) {
  Settings s = settings();
  vec3 body = vec3(0.0);
  vec3 seen_water = vec3(0.0);
  vec3 colour = vec3(0.0);
  for (int ray = has_water ? kFrameBottom : kFrameCamera; ray >= kFrameCamera; --ray) {
    FrameSeen seen = Seens(push.seens).of[seen_index(ray, slot)];
    vec3 direction = direction_of(seen.line);
    bool in_water = has_water && ray == kFrameBottom;
    bool on_water = has_water && ray == kFrameCamera && water.kind != 0;
    float metres = (on_water ? water.t.high : seen.t.high) * seen.metres;
    colour = seen.kind == kFrameGround ? seen.light : vec3(0.0);
    if (seen.kind == kFrameWall && !in_water) colour = wall_colour(seen, direction);
    if (on_water) colour = seen_water;
    if (seen.kind == kFrameNothing && !on_water)
      colour = sky_behind(seen, direction);
    else if (!in_water)
      colour = in_air(colour, seen, direction, metres);
    if (in_water) body = water_body(seen, colour);
    if (has_water && ray == kFrameMirror) {
      seen_water = colour * water.reflectance + body * (1.0 - water.reflectance);
      if (has_scattering && seen.kind == kFrameNothing) seen_water += water.glitter * left_from_beyond(seen, direction);
    }
    if (has_scattering && ray == kFrameCamera && !on_water && seen.kind == kFrameNothing)
      colour += scarp_sun_disc(the_sky(), direction) * left_from_beyond(seen, direction);
    if (has_fog && ray == kFrameCamera && s.is.fog == kScarpFogByIterations)
      colour = scarp_between(colour, scarp_fog_colour(the_sky(), direction, s.is.sun_tint),
                             min(1.0, float(seen.steps) / float(s.is.most_steps)));
  }
  return colour;
}

// Colour in a picture of the steps.
vec3 share_of_steps(FrameSeen camera, bool meets) {
  float share = min(1.0, float(camera.steps) / float(settings().is.most_steps));
  // A stepped ray that hits nothing takes all its steps, sampled or not.
  return vec3(stepped && !meets ? 1.0 : share);
}

void tell_sight(uint pixel, FrameSeen camera, FrameWater water) {
  FrameSight sight;
  sight.kind = water.kind != 0 ? kFrameWater : camera.kind;
  sight.t = (water.kind != 0 ? water.t.high : camera.t.high) * camera.metres;
  sight.cell = camera.cell;
  sight.steps = camera.steps;
  Sights(push.sights).of[pixel] = sight;
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= push.threads) return;
  Settings s = settings();
  FrameSeen camera = Seens(push.seens).of[slot];
  FrameWater water;
  water.kind = 0;
  if (has_water) water = Waters(push.waters).of[slot];
  if (push.point == 0 && push.tell_sights != 0u) tell_sight(push.first + slot, camera, water);
  FrameSum sum = FrameSum(vec3(0.0), 0);
  if (push.point > 0) sum = Sums(push.sums).of[slot];
  if (s.is.alpha == 0 || camera.kind == kFrameGround || water.kind != 0) {
    bool meets = camera.kind != kFrameNothing || water.kind != 0;
    sum.colour += s.is.iterations != 0 ? share_of_steps(camera, meets) : colour_of_point(slot, water);
    sum.shown += 1;
  }
  int points = s.is.aa * s.is.aa;
  if (push.point + 1 < points) {
    Sums(push.sums).of[slot] = sum;
    return;
  }
  vec3 colour = sum.colour / float(max(sum.shown, 1));
  if (s.is.tone_curve != 0) colour = scarp_toned(colour);
  Indices(push.pixels).of[slot] = uint(scarp_srgb_byte(colour.x)) | (uint(scarp_srgb_byte(colour.y)) << 8) |
                                  (uint(scarp_srgb_byte(colour.z)) << 16) |
                                  (scarp_frame_opacity(float(sum.shown) / float(points)) << 24);
}
