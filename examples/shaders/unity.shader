// SPDX-License-Identifier: MIT
// Hills, marched by `fixed-step`. Unity, built-in render pipeline: the shader of a material on a Quad or a RawImage.
Shader "Scarp/Hills" {
  Properties {
    _Aspect("Width / height", Float) = 1.7778
  }
  SubShader {
    Pass {
      HLSLPROGRAM
#pragma vertex vert
#pragma fragment frag
#pragma target 3.5
#include "UnityCG.cginc"
#define vec2 float2
#define vec3 float3

float _Aspect;

float scarp_ground(vec2 p) {
  return 18.0 * sin(0.021 * p.x) * cos(0.017 * p.y) + 3.0 * sin(0.11 * p.x + 0.07 * p.y);
}

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

vec3 normal_at(vec2 p) {
  float d = 0.5;
  return normalize(vec3(scarp_ground(p - vec2(d, 0.0)) - scarp_ground(p + vec2(d, 0.0)),
                        scarp_ground(p - vec2(0.0, d)) - scarp_ground(p + vec2(0.0, d)), 2.0 * d));
}

struct Corner {
  float4 position : SV_POSITION;
  float2 uv : TEXCOORD0;
};

Corner vert(float4 position : POSITION, float2 uv : TEXCOORD0) {
  Corner corner;
  corner.position = UnityObjectToClipPos(position);
  corner.uv = uv;
  return corner;
}

float4 frag(Corner corner) : SV_Target {
  vec2 place = (2.0 * corner.uv - 1.0) * vec2(_Aspect, 1.0);
  vec3 eye = vec3(30.0 * _Time.y, 0.0, 45.0);  // x ahead, y to the left, z up
  vec3 direction = normalize(vec3(1.5, -place.x, place.y - 0.4));
  vec3 sun = normalize(vec3(-0.4, 0.6, 0.5));
  vec3 air = lerp(vec3(0.75, 0.85, 0.95), vec3(0.3, 0.5, 0.85), max(place.y, 0.0));
  vec3 colour = air;
  float t;
  if (scarp_fixed_step(eye, direction, 1500.0, 2.0, 16384, t) == 1) {
    vec3 p = eye + t * direction;
    float bright = max(dot(normal_at(p.xy), sun), 0.0);
    colour = lerp(vec3(0.35, 0.45, 0.25) * (0.3 + 0.9 * bright), air, t / 1500.0);
  }
  return float4(colour, 1.0);
}
      ENDHLSL
    }
  }
}
