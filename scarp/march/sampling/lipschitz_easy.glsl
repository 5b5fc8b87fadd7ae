// SPDX-License-Identifier: MIT
// Scarp's march `lipschitz` over terrain that is a function, to paste into shaders. GLSL ES 3.00 and later, so also
// Shadertoy and Godot; HLSL after `#define vec2 float2` and `#define vec3 float3`.
//
// Define the ground above this code; z is up: float scarp_ground(vec2 p) { return sin(p.x) * sin(p.y); }
//
// Rule. h is the height of the ray above the ground. If the ground is nowhere steeper than `slope`, no ground is nearer
// than f = h / sqrt(1 + slope^2), so a step of that length is safe:
//   f <= tolerance * t: hit;   t += f
//
// The slope is that of the steepest ground: the maximum of |gradient|, 1 for the ground above. Octaves add up: each has
// at most amplitude * 2 pi / wavelength if it is a sine.
//
// Usual values: tolerance 0.0005, max_steps 1024.
// Units: t and h count in lengths of `direction`, which need not be a unit vector. The ray ends at t_max.
//
// Returns 0: miss; 1: hit at origin + t * direction; 2: below, the ray starts below the ground;
// 3: exhausted, max_steps points up to t gave no answer, or the ray is below the ground at t: `slope` is too low.
//
// Conservative up to the rounding of floats: it never passes through the ground, but stops in front of it within the
// tolerance. Source: J. C. Hart, "Sphere tracing", The Visual Computer 12, 1996.
int scarp_lipschitz(vec3 origin, vec3 direction, float t_max, float slope, float tolerance, int max_steps,
                    out float t) {
  float shrink = 1.0 / (length(direction) * sqrt(1.0 + slope * slope));
  t = 0.0;
  for (int i = 0; t <= t_max; ++i) {
    if (i == max_steps) return 3;
    vec3 p = origin + t * direction;
    float f = (p.z - scarp_ground(vec2(p.x, p.y))) * shrink;
    if (f < 0.0) return i == 0 ? 2 : 3;
    if (f <= tolerance * t || t + f <= t) return 1;
    t += f;
  }
  return 0;
}
