// SPDX-License-Identifier: MIT
// Looks up a DetailTexture (detail_texture.h). Compiles as C++ and GLSL. The including file must first define:
//   struct ScarpTexels                                refers to the texels of all levels
//   real scarp_texel(ScarpTexels texels, int index)   returns a texel: rows from the north, the finest level first
#ifndef SCARP_RENDER_DETAIL_TEXTURE_GLSL_H
#define SCARP_RENDER_DETAIL_TEXTURE_GLSL_H

#include "scarp/vk/real.glsl.h"

SCARP_GLSL_BEGIN

/// Number of levels above the finest one of an image with sides of DetailTexture::kMostSide.
const int kScarpMostTextureLevels = 13;

/// Size in texels of the next coarser level.
SCARP_FN ivec2 scarp_coarser_texture(ivec2 size) { return ivec2(max(1, size.x / 2), max(1, size.y / 2)); }

/// Interpolates bilinearly in the level of this size that starts at `begin`, with wrap-around. `place`: fractions of
/// the image from its north-west corner to the east and south, 0 to 1.
SCARP_FN real scarp_texture_at(ScarpTexels texels, int begin, ivec2 size, real2 place) {
  real x = place.x * real(size.x) - real(0.5);
  real y = place.y * real(size.y) - real(0.5);
  int col = int(floor(x));
  int row = int(floor(y));
  real to_east = x - real(col);
  real to_south = y - real(row);
  real sum = real(0.0);
  for (int i = 0; i < 4; ++i) {
    int c = (col + i % 2 + size.x) % size.x;
    int r = (row + i / 2 + size.y) % size.y;
    sum += (i % 2 != 0 ? to_east : real(1.0) - to_east) * (i / 2 != 0 ? to_south : real(1.0) - to_south) *
           scarp_texel(texels, begin + r * size.x + c);
  }
  return sum;
}

/// The texture at a position where a pixel is `covered` texels of the finest level wide: a mixture of the level whose
/// texels are half a pixel to a pixel wide and the next coarser one.
SCARP_FN real scarp_texture_detail(ScarpTexels texels, ivec2 size, real2 place, real covered) {
  int begin = 0;
  // All lanes run all iterations: if some leave a loop early, lavapipe (Mesa 22.3) returns values of other lanes.
  for (int level = 0; level < kScarpMostTextureLevels; ++level) {
    bool coarser = covered > real(2.0) && (size.x > 1 || size.y > 1);
    begin += coarser ? size.x * size.y : 0;
    size = coarser ? scarp_coarser_texture(size) : size;
    covered = coarser ? real(0.5) * covered : covered;
  }
  real share = clamp(covered - real(1.0), real(0.0), real(1.0));
  bool last = size.x == 1 && size.y == 1;
  real fine = scarp_texture_at(texels, begin, size, place);
  real coarse = scarp_texture_at(texels, last ? begin : begin + size.x * size.y, scarp_coarser_texture(size), place);
  return fine * (real(1.0) - share) + coarse * share;
}

SCARP_GLSL_END

#endif
