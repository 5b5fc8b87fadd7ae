// SPDX-License-Identifier: MIT
// A ray to the sun or the sky from each visible ground point, in the order of Lighting::ask(): a stage of
// terrain_frame.glsl.h.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/render/frame/terrain_frame_stage.glsl.h"
// The following files use its definitions of ground and directions.
#include "scarp/march/height/surface_normal.glsl.h"
#include "scarp/render/frame/terrain_frame_send.glsl.h"
#include "scarp/render/light/sample_directions.glsl.h"
#include "scarp/render/light/sample_pattern.glsl.h"

// Point i of a pixel for a purpose.
vec2 sample_point(uint pixel, uint purpose, int i) {
  Settings s = settings();
  uint width = uint(s.is.width);
  return scarp_pixel_point(scarp_pixel_points(s.is.seed, s.is.index_bits, pixel % width, pixel / width, purpose),
                           uint(s.is.samples * push.point + i));
}

// A light ray of a visible point, and its weight if nothing blocks it.
struct LightRay {
  ScarpLine line;
  float end;  // metres
  float weight;
};
LightRay light_ray(ScarpField field, FrameSeen seen, uint pixel) {
  Settings s = settings();
  ScarpTwoFloat x = scarp_line_col(seen.line, seen.t);
  ScarpTwoFloat y = scarp_line_row(seen.line, seen.t);
  ScarpTwoFloat z = scarp_line_height(seen.line, seen.t);
  LightRay ray;
  ray.line = ScarpLine(vec3(x.high, y.high, z.high), vec3(x.low, y.low, z.low), s.is.sun_line, s.is.sun_line_low);
  vec3 direction = s.is.to_sun;
  bool to_sun = goes_to_sun();
  if (has_samples && (!to_sun || s.is.sun_depth > 0.0)) {
    // A single call of sample_point() keeps the shader small.
    vec2 at = sample_point(pixel, to_sun ? kScarpPointsOfSun : kScarpPointsOfSky,
                           to_sun ? push.light : push.light - s.is.sun_rays);
    vec3 axis = to_sun ? s.is.to_sun : normal_of(scarp_slope(field, seen.cell, seen.place));
    direction = scarp_round_axis(axis, to_sun ? scarp_in_cap(at, s.is.sun_depth) : scarp_cosine_weighted(at));
    ray.line.direction = grid_direction(direction);
    ray.line.direction_low = vec3(0.0);
  }
  ray.weight = to_sun ? max(0.0, dot(seen.normal, direction)) : 1.0;
  ray.end = to_sun ? kScarpNever : s.is.ao_distance;
  // Rays over wrapped ground need an end: there is nothing above the highest summit, and low rays end far away.
  if (to_sun && (field.flags & kScarpWraps) != 0u)
    ray.end = max((field.highest - z.high) * s.is.metres_per_sample, 0.0) / max(direction.z, kScarpLeastSunRise);
  return ray;
}

void main() {
  uint at = gl_GlobalInvocationID.x;
  if (at >= push.threads) return;
  uint i = Indices(push.grounds).of[at];
  FrameSeen seen = Seens(push.seens).of[i];
  ScarpField field = shown_field();
  LightRay light = light_ray(field, seen, push.first + i % push.count);
  uint how = kScarpSendFromSurface | (stepped ? kScarpSendSampled : 0u);
  ScarpSent sent = scarp_send(field, light.line, scarp_two(0.0), scarp_two(light.end), how, seen.cell, seen.place);
  if (light.weight > 0.0 && sent.marches != 0) {
    Seens(push.seens).of[i].weight = light.weight;
    list_ray(sent, settings().is.sun_step, i);
  } else if (goes_to_sun()) {
    // Nothing blocks it.
    Seens(push.seens).of[i].sun_cosine = seen.sun_cosine + light.weight;
  } else {
    Seens(push.seens).of[i].sky = seen.sky + 1.0;
  }
}
