// SPDX-License-Identifier: MIT
// Rays to sun and sky for terrain_frame.comp, which includes this: those of Lighting::ask(), in its order. GLSL.

#include "scarp/render/light/sample_directions.glsl.h"
#include "scarp/render/light/sample_pattern.glsl.h"

// Of the invocation.
uint pixel;
int point;  // of the pixel

int light_rays() {
  if (!has_samples) return has_shadows ? 1 : 0;
  return settings().is.sun_rays + settings().is.sky_rays;
}
// Whether a ray goes to the sun, those before the others; else to the sky.
bool goes_to_sun(int light) { return has_samples ? light < settings().is.sun_rays : has_shadows; }

vec2 sample_point(uint purpose, int i) {
  Settings s = settings();
  uint width = uint(s.is.width);
  return scarp_pixel_point(scarp_pixel_points(s.is.seed, s.is.index_bits, pixel % width, pixel / width, purpose),
                           uint(s.is.samples * point + i));
}

// Ray `light` of the light on what has been seen, and what it counts for where nothing is in its way.
struct LightRay {
  ScarpLine line;
  float end;  // metres
  float weight;
};
LightRay light_ray(ScarpField field, FrameSeen seen, int light) {
  Settings s = settings();
  ScarpTwoFloat x = scarp_line_col(seen.line, seen.t);
  ScarpTwoFloat y = scarp_line_row(seen.line, seen.t);
  ScarpTwoFloat z = scarp_line_height(seen.line, seen.t);
  LightRay ray;
  ray.line = ScarpLine(vec3(x.high, y.high, z.high), vec3(x.low, y.low, z.low), s.is.sun_line, s.is.sun_line_low);
  vec3 direction = s.is.to_sun;
  bool to_sun = goes_to_sun(light);
  if (has_samples && (!to_sun || s.is.sun_depth > 0.0)) {
    // One place where points are asked for keeps the shader small.
    vec2 at = sample_point(to_sun ? kScarpPointsOfSun : kScarpPointsOfSky, to_sun ? light : light - s.is.sun_rays);
    vec3 axis = to_sun ? s.is.to_sun : normal_of(scarp_slope(field, seen.cell, seen.place));
    direction = scarp_round_axis(axis, to_sun ? scarp_in_cap(at, s.is.sun_depth) : scarp_cosine_weighted(at));
    ray.line.direction = grid_direction(direction);
    ray.line.direction_low = vec3(0.0);
  }
  ray.weight = to_sun ? max(0.0, dot(seen.normal, direction)) : 1.0;
  ray.end = to_sun ? kScarpNever : s.is.ao_distance;
  // Rays over endless ground need an end: above the highest summit nothing is met, and low rays end far away.
  if (to_sun && (field.flags & kScarpWraps) != 0u)
    ray.end = max((field.highest - z.high) * s.is.metres_per_sample, 0.0) / max(direction.z, kScarpLeastSunRise);
  return ray;
}
