// SPDX-License-Identifier: MIT
// Scarp's march `naive` over terrain that is a function, to paste into shaders. GLSL ES 3.00 and later, so
// also Shadertoy and Godot; HLSL after `#define vec2 float2` and `#define vec3 float3`.
//
// Define the ground above this code; z is up: float scarp_ground(vec2 p) { return sin(p.x) * sin(p.y); }
//
// Rule. h is the height of the ray above the ground. Ground that is near is a hit; otherwise the ray steps by its
// height:
//   h < tolerance * t: hit;   t += max(step_factor * h, min_step * t_max)
//
// Usual values: step_factor 0.7, min_step 1.0 / 512.0, tolerance 0.001, max_steps 1024.
// Units: t and h count in lengths of `direction`, which need not be a unit vector. The ray ends at t_max.
//
// Returns 0: miss; 1: hit at origin + t * direction; 3: exhausted, max_steps points up to t gave no answer.
// A ray that starts below the ground hits at its start.
//
// Approximate: it passes through steep ground, and stops in front of the ground within the tolerance.
// Source: "Raymarching Heightfields: Basics and Optimizations", 2026, the march that its max-mips are compared with.
int scarp_naive(vec3 origin, vec3 direction, float t_max, float step_factor, float min_step, float tolerance,
                int max_steps, out float t) {
  float per_metre = 1.0 / length(direction);
  float least = min_step * t_max;
  t = 0.0;
  for (int i = 0; t <= t_max; ++i) {
    if (i == max_steps) return 3;
    vec3 p = origin + t * direction;
    float h = (p.z - scarp_ground(vec2(p.x, p.y))) * per_metre;
    if (h < tolerance * t) return 1;
    t += max(step_factor * h, least);
  }
  return 0;
}
