// SPDX-License-Identifier: MIT
// Scarp's march `fixed-step` over terrain that is a function, to paste into shaders. GLSL ES 3.00 and later, so also
// Shadertoy and Godot; HLSL after `#define vec2 float2` and `#define vec3 float3`.
//
// Define the ground above this code; z is up: float scarp_ground(vec2 p) { return sin(p.x) * sin(p.y); }
//
// Rule. h is the height of the ray above the ground. The ray is sampled every `stride`, and at its end. The first
// sample on or below the ground after one above it is a hit, which moves to where a straight line through the last two
// heights is 0:
//   t_i = min(i * stride, t_max);   h_before > 0 >= h: hit at t_before + (t - t_before) * h_before / (h_before - h)
//
// Usual values: stride 5.0, for ground in metres whose features are larger than that; max_steps 16384.
// Units: `stride` is a length in units of the ground. t counts in lengths of `direction`, which need not be a unit
// vector. The ray ends at t_max.
//
// Returns 0: miss; 1: hit at origin + t * direction; 2: below, the ray starts below the ground and hits nothing later;
// 3: exhausted, max_steps samples up to t gave no answer.
//
// Approximate: it misses ground that is thinner than a step.
// Source: I. Quilez, "Terrain raymarching", 2002.
int scarp_fixed_step(vec3 origin, vec3 direction, float t_max, float stride, int max_steps, out float t) {
  float dt = stride / length(direction);
  float t_before = 0.0, h_before = 0.0;
  int missed = 0;
  t = 0.0;
  for (int i = 0; i < max_steps; ++i) {
    t = min(float(i) * dt, t_max);
    vec3 p = origin + t * direction;
    float h = p.z - scarp_ground(vec2(p.x, p.y));
    if (h <= 0.0 && h_before > 0.0) {
      t = t_before + (t - t_before) * (h_before / (h_before - h));
      return 1;
    }
    if (i == 0 && h == 0.0) return 1;
    if (i == 0 && h < 0.0) missed = 2;
    if (t >= t_max) return missed;
    t_before = t;
    h_before = h;
  }
  return 3;
}
