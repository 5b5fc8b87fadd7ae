// SPDX-License-Identifier: MIT
// Hills, marched by `relaxed`. Paste all of this into a new shader of shadertoy.com, tab "Image".

float scarp_ground(vec2 p) {
  return 18.0 * sin(0.021 * p.x) * cos(0.017 * p.y) + 3.0 * sin(0.11 * p.x + 0.07 * p.y);
}

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

vec3 normal_at(vec2 p) {
  float d = 0.5;
  return normalize(vec3(scarp_ground(p - vec2(d, 0.0)) - scarp_ground(p + vec2(d, 0.0)),
                        scarp_ground(p - vec2(0.0, d)) - scarp_ground(p + vec2(0.0, d)), 2.0 * d));
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
  vec2 place = (2.0 * fragCoord - iResolution.xy) / iResolution.y;
  vec3 eye = vec3(30.0 * iTime, 0.0, 45.0);  // x ahead, y to the left, z up
  vec3 direction = normalize(vec3(1.5, -place.x, place.y - 0.4));
  vec3 sun = normalize(vec3(-0.4, 0.6, 0.5));
  vec3 air = mix(vec3(0.75, 0.85, 0.95), vec3(0.3, 0.5, 0.85), max(place.y, 0.0));
  vec3 colour = air;
  float t;
  int status = scarp_relaxed(eye, direction, 1500.0, 0.4, 0.0015, 300, t);
  if (status == 1 || status == 3) {  // out of steps at a crest, the ray is close to the ground
    vec3 p = eye + t * direction;
    float bright = max(dot(normal_at(p.xy), sun), 0.0);
    colour = mix(vec3(0.35, 0.45, 0.25) * (0.3 + 0.9 * bright), air, t / 1500.0);
  }
  fragColor = vec4(colour, 1.0);
}
