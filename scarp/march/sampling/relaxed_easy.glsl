// SPDX-License-Identifier: MIT
// Scarp's march `relaxed` over terrain that is a function, to paste into shaders. GLSL ES 3.00 and later, so also
// Shadertoy and Godot; HLSL after `#define vec2 float2` and `#define vec3 float3`.
//
// Define the ground above this code; z is up: float scarp_ground(vec2 p) { return sin(p.x) * sin(p.y); }
//
// Rule. h is the height of the ray above the ground, negative below it. From below the ground the ray steps back:
//   |h| < tolerance * t: hit;   t += step_factor * h
//
// Usual values: step_factor 0.4, tolerance 0.0015, max_steps 300.
// Units: t and h count in lengths of `direction`, which need not be a unit vector. The ray ends at t_max.
//
// Returns 0: miss; 1: hit at origin + t * direction; 2: below, the ray starts below the ground;
// 3: exhausted, max_steps points up to t gave no answer.
//
// Approximate: it passes through steep ground, and stops beside the ground within the tolerance.
// Source: R. Ma, "Heightfield raycast", procedural_shader_framework; the numbers are those of I. Quilez, "Elevated",
// 2009.
int scarp_relaxed(vec3 origin, vec3 direction, float t_max, float step_factor, float tolerance, int max_steps,
                  out float t) {
  float per_metre = 1.0 / length(direction);
  t = 0.0;
  for (int i = 0; t <= t_max; ++i) {
    if (i == max_steps) return 3;
    vec3 p = origin + t * direction;
    float h = (p.z - scarp_ground(vec2(p.x, p.y))) * per_metre;
    if (abs(h) < tolerance * t) return 1;
    if (h < 0.0 && i == 0) return 2;
    t = max(t + step_factor * h, 0.0);
  }
  return 0;
}
