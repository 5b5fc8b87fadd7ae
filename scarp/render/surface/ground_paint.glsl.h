// SPDX-License-Identifier: MIT
// Colours of ground: the formulas of ground_paint.h. Compiles as C++ and GLSL. The including file must first define:
//   struct ScarpPaintPlace, a point on the ground, and
//   real scarp_paint_noise(ScarpPaintPlace place, int set, int octave, real size)
//                                              Perlin noise, seed octave + 1, of patches `size` metres large; `set` and
//                                              `octave` name them: see scarp_patches()
#ifndef SCARP_RENDER_GROUND_PAINT_GLSL_H
#define SCARP_RENDER_GROUND_PAINT_GLSL_H

#include "scarp/render/surface/contours.glsl.h"

SCARP_GLSL_BEGIN

// sRGB.
const vec3 kScarpMeadow = vec3(0.36f, 0.43f, 0.22f);
const vec3 kScarpForest = vec3(0.20f, 0.30f, 0.16f);
const vec3 kScarpDry = vec3(0.60f, 0.55f, 0.36f);
const vec3 kScarpRock = vec3(0.47f, 0.43f, 0.40f);
const vec3 kScarpScree = vec3(0.60f, 0.56f, 0.51f);
const vec3 kScarpSnow = vec3(0.93f, 0.95f, 0.98f);

/// Sets of patches: their purpose, their octaves, and the size of the largest relative to the detail.
const int kScarpDetail = 0;
const int kScarpBlur = 1;
const int kScarpRough = 2;
const int kScarpPatchSets = 3;
const int kScarpMostOctaves = 4;
SCARP_FN int scarp_patch_octaves(int set) { return set == kScarpDetail ? 4 : set == kScarpBlur ? 3 : 2; }
SCARP_FN real scarp_patch_size(int set, real detail_size) {
  return set == kScarpDetail ? detail_size : set == kScarpBlur ? real(3.0) * detail_size : real(0.7) * detail_size;
}
/// Size of the next octave.
SCARP_FN real scarp_smaller_patch(real size) { return size / real(2.17); }

/// Direction, in x and y of the world, in which patches of an octave are stretched: alternating, so that no two octaves
/// have the same grain. They are twice as long along it as across.
SCARP_FN real2 scarp_patch_grain(int octave) {
  return octave % 2 == 0 ? real2(real(0.8), real(0.6)) : real2(real(0.6), real(-0.8));
}

/// Noise of a set; patches smaller than a pixel, `footprint` metres wide, are omitted.
SCARP_FN real scarp_patches(ScarpPaintPlace place, int set, real detail_size, real footprint) {
  real size = scarp_patch_size(set, detail_size);
  real sum = real(0.0);
  real weight = real(1.0);
  for (int i = 0; i < scarp_patch_octaves(set); ++i) {
    real seen = clamp(size / (real(2.0) * footprint) - real(1.0), real(0.0), real(1.0));
    if (seen == real(0.0)) break;
    sum += weight * seen * scarp_paint_noise(place, set, i, size);
    size = scarp_smaller_patch(size);
    weight *= real(0.62);
  }
  return sum;
}

/// Rock, grass and snow, in linear light. `share`: height of the ground as a fraction of the relief; `normal`: unit;
/// `from_sun`: x and y away from the sun; `snow_share`: fraction of the relief where snow begins; `blur` and `rough`:
/// the patches of these sets.
SCARP_FN vec3 scarp_natural(real share, real3 normal, real2 from_sun, real snow_share, real blur, real rough) {
  real steep = sqrt(max(real(0.0), real(1.0) - normal.z * normal.z));
  vec3 colour =
      scarp_between(kScarpForest, kScarpMeadow, scarp_smooth(real(0.08), real(0.35), share + real(0.10) * blur));
  colour = scarp_between(colour, kScarpDry, scarp_smooth(real(0.30), real(0.62), share + real(0.16) * blur));
  vec3 rock = scarp_between(kScarpRock, kScarpScree, scarp_smooth(real(-0.4), real(0.6), rough));
  // Sines of slopes between which grass gives way to rock.
  colour = scarp_between(
      colour, rock, scarp_smooth(real(0.45), real(0.68), steep + real(0.10) * blur + real(0.35) * (share - real(0.5))));
  // How much lower the snow line is on the shadowed side, the width of its border, and cosines below which snow slides
  // off.
  real line = snow_share - real(0.10) * (normal.x * from_sun.x + normal.y * from_sun.y);
  real snow = scarp_smooth(line - real(0.05), line + real(0.05), share + real(0.07) * blur) *
              scarp_smooth(real(0.55), real(0.72), normal.z + real(0.06) * rough);
  return scarp_linear_from_srgb(scarp_between(colour, kScarpSnow, snow));
}

/// Converts a fraction of the extent to a position in a picture: 0..1 from its north-west corner, beyond 0..1 outside
/// the picture. See Drape in ground_paint.h.
SCARP_FN real2 scarp_drape_place(real2 share, real2 first, real2 last, bool mirrored) {
  // The border of the extent, up to rounding.
  share = clamp(share, real2(0.0), real2(1.0));
  // The raster lies in the south-west quarter.
  if (mirrored) share = real2(real(1.0) - abs(real(2.0) * share.x - real(1.0)), abs(real(2.0) * share.y - real(1.0)));
  return (share - first) / (last - first);
}

SCARP_GLSL_END

#endif
