// SPDX-License-Identifier: MIT
// Contour lines of constant width in pixels over the colour of a surface: see ground_paint.h. Compiles as C++ and GLSL.
#ifndef SCARP_RENDER_CONTOURS_GLSL_H
#define SCARP_RENDER_CONTOURS_GLSL_H

#include "scarp/render/light/colour.glsl.h"

SCARP_GLSL_BEGIN

/// sRGB.
const vec3 kScarpContour = vec3(0.24f, 0.16f, 0.10f);

/// 0 up to `from`, 1 from `to` on, with level ends.
SCARP_FN real scarp_smooth(real from, real to, real x) {
  real s = clamp((x - from) / (to - from), real(0.0), real(1.0));
  return s * s * (real(3.0) - real(2.0) * s);
}

/// Minimum cosine to the vertical, which keeps the slopes of walls finite.
const float kScarpLeastUpright = 1e-9f;

/// Number of contour lines per heavy one, from height 0 on.
const int kScarpHeavyContour = 5;

/// Spacings in pixels up to which lines are omitted, and from which they have full opacity.
const float kScarpTouchingContours = 3.0f;
const float kScarpClearContours = 8.0f;

/// Ground counts as level if lines would be farther apart than this many pixels, sixteen times the longest side of a
/// picture: its slope there is only rounding of its samples.
const float kScarpLevelContours = 1048576.0f;

/// Metres of height that a pixel `footprint` metres wide covers; 0: level. The slope is limited to 1, so the result is
/// at most the length on the surface. Computed from x and y, because the rounding of 1 - z^2 would give level surfaces
/// a slope.
SCARP_FN real scarp_height_per_pixel(real3 normal, real footprint) {
  real slope = sqrt(normal.x * normal.x + normal.y * normal.y) / max(normal.z, real(kScarpLeastUpright));
  return min(slope, real(1.0)) * footprint;
}

/// Adds contour lines, `interval` metres apart. `normal` is that of the surface itself: next to level ground, smooth
/// normals lean, and level ground at a line's height would be painted as a whole. Level ground has lines only at its
/// border.
SCARP_FN vec3 scarp_with_contours(vec3 colour, real height, real3 normal, real footprint, real interval) {
  real per_pixel = scarp_height_per_pixel(normal, footprint);
  if (per_pixel * real(kScarpLevelContours) <= interval) return colour;
  real line = floor(height / interval + real(0.5));
  real pixels = abs(height - line * interval) / per_pixel;
  // 0.1 is a tenth of a line, more than the rounding of the quotient.
  real fifth = abs(line) - real(kScarpHeavyContour) * floor(abs(line) / real(kScarpHeavyContour) + real(0.1));
  bool heavy = fifth == real(0.0);
  real width = heavy ? real(2.0) : real(1.1);
  // Heavy lines are five times as far apart, and fade later.
  real apart = interval * (heavy ? real(kScarpHeavyContour) : real(1.0)) / per_pixel;
  real ink = clamp(width / real(2.0) + real(0.5) - pixels, real(0.0), real(1.0)) *
             scarp_smooth(real(kScarpTouchingContours), real(kScarpClearContours), apart) *
             (heavy ? real(0.85) : real(0.6));
  return scarp_between(colour, scarp_linear_from_srgb(kScarpContour), ink);
}

SCARP_GLSL_END

#endif
