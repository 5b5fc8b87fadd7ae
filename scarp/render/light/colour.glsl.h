// SPDX-License-Identifier: MIT
// Colours: conversion between sRGB and linear light, and interpolation. Compiles as C++ and GLSL.
#ifndef SCARP_RENDER_COLOUR_GLSL_H
#define SCARP_RENDER_COLOUR_GLSL_H

#include "scarp/vk/real.glsl.h"

SCARP_GLSL_BEGIN

/// Interpolates from `from` to `to`, share 0..1.
SCARP_FN vec3 scarp_between(vec3 from, vec3 to, real share) {
  float f = float(share);
  return from * (1.0f - f) + to * f;
}

/// sRGB 0..1 to linear light (IEC 61966-2-1).
SCARP_FN float scarp_linear_channel(float s) { return s <= 0.04045f ? s / 12.92f : pow((s + 0.055f) / 1.055f, 2.4f); }
SCARP_FN vec3 scarp_linear_from_srgb(vec3 srgb) {
  return vec3(scarp_linear_channel(srgb.x), scarp_linear_channel(srgb.y), scarp_linear_channel(srgb.z));
}

/// The inverse, to 0..255, rounded and clamped.
SCARP_FN float scarp_srgb_byte(float linear) {
  float c = clamp(linear, 0.0f, 1.0f);
  float s = c <= 0.0031308f ? 12.92f * c : 1.055f * pow(c, 1.0f / 2.4f) - 0.055f;
  return floor(255.0f * s + 0.5f);
}

// The tone curve starts at the first value, which does not change white level ground of a reflectance of 70 %. The
// second one maps to 1: the light on a white slope that faces a sun at 30 degrees is 1.71.
const float kScarpToneBegin = 0.7f;
const float kScarpToneFull = 1.75f;

/// Compresses bright colours in linear light: the largest channel by a curve with the initial slope 1, the others in
/// proportion, which preserves hues. Above kScarpToneFull, as near the sun, colours fade to white.
SCARP_FN vec3 scarp_toned(vec3 linear) {
  float most = max(linear.x, max(linear.y, linear.z));
  if (!(most > kScarpToneBegin)) return linear;
  if (most > 1e30f) return vec3(1.0f);  // may be infinite
  float range = 1.0f - kScarpToneBegin;
  float full = (kScarpToneFull - kScarpToneBegin) / range;
  float at = min((most - kScarpToneBegin) / range, full);
  float toned = kScarpToneBegin + range * at / (1.0f + (full - 1.0f) / full * at);
  vec3 colour = linear * (toned / most);
  return scarp_between(vec3(1.0f), colour, min(real(1.0), real(kScarpToneFull / most)));
}

/// Position of a value in a table of `count` colours, evenly spaced from `low` to `high`: entry + fraction, 0..1,
/// towards the next one.
struct ScarpTablePlace {
  int entry;
  float place;
};
SCARP_FN ScarpTablePlace scarp_table_place(real value, real low, real high, int count) {
  real extent = high - low;
  real share = extent > real(0.0) ? clamp((value - low) / extent, real(0.0), real(1.0)) : real(0.0);
  real at = share * real(count - 1);
  ScarpTablePlace found;
  found.entry = min(int(at), count - 2);
  found.place = float(at - real(found.entry));
  return found;
}

SCARP_GLSL_END

#endif
