#version 300 es
// SPDX-License-Identifier: MIT
// All marches over textures, as GLSL ES 3.0.
precision highp float;
precision highp int;

uniform highp sampler2D scarp_heights, scarp_bounds;
uniform highp float scarp_nodata;
uniform ivec2 cells;
uniform int march;
out vec4 colour;

#include "scarp/march/height/textures.glsl.h"
// The marches read their ground from the textures.
#include "scarp/march/height/float_ray.glsl.h"
#include "scarp/march/height/height_marches.glsl.h"
#include "scarp/march/height/max_mip.glsl.h"
#include "scarp/march/height/surface_normal.glsl.h"
#include "scarp/march/height/two_float_ray.glsl.h"

void main() {
  ScarpField field;
  field.cells = cells;
  field.samples = cells + 1;
  field.top_level = 10;
  field.flags = 0u;
  field.code_base = 0.0;
  field.code_base_low = 0.0;
  field.code_step = 1.0;
  field.lowest = 0.0;
  field.highest = 1.0;
  ScarpRay ray;
  if (!scarp_ray_from(field, vec3(gl_FragCoord.xy, 9.0), vec3(1.0, 0.25, -0.125), kScarpNever, ray)) discard;
  ScarpHit hit;
  if (march == 0)
    hit = scarp_max_mip(field, ray, false);
  else if (march == 1)
    hit = scarp_sampled(field, ray, scarp_naive(0.7, 0.01, 0.001, 100));
  else if (march == 2)
    hit = scarp_sampled(field, ray, scarp_fixed_step(0.5, kScarpRefineSecant, 100));
  else if (march == 3)
    hit = scarp_sampled(field, ray, scarp_relaxed(0.4, 0.001, 100));
  else
    hit = scarp_sampled(field, ray, scarp_lipschitz(0.5, 0.001, 100));
  colour = vec4(hit.place, hit.time, float(hit.status));
}
