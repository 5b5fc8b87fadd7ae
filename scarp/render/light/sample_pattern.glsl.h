// SPDX-License-Identifier: MIT
// Positions of a pixel's samples in the unit square: the formulas of sample_pattern.h. Compiles as C++ and GLSL;
// integers are bit-identical on both sides.
#ifndef SCARP_RENDER_SAMPLE_PATTERN_GLSL_H
#define SCARP_RENDER_SAMPLE_PATTERN_GLSL_H

#include "scarp/vk/real.glsl.h"

SCARP_GLSL_BEGIN

// Purposes of a pixel's points.
const uint kScarpPointsOfSky = 0u;
const uint kScarpPointsOfSun = 1u;

/// The points of one pixel for one purpose.
struct ScarpPixelPoints {
  uint x;  ///< coordinates of the pixel's first point, before scrambling
  uint y;
  uint seed_x;
  uint seed_y;
  uint seed_order;
  int index_bits;  ///< number of index bits in a pixel's block of the sequence
};

/// A bijection of 32 bits in which every bit of the result depends on all (Wellons 2018, "lowbias32").
SCARP_FN uint scarp_scatter(uint number) {
  uint x = number;
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}
SCARP_FN uint scarp_scatter_two(uint x, uint y) { return scarp_scatter(x ^ scarp_scatter(y + 0x9e3779b9u)); }

SCARP_FN uint scarp_reverse_bits(uint number) {
  uint x = number;
  x = ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
  return (x << 16) | (x >> 16);
}

/// Flips each bit or not, depending on all bits above it and on the seed: on the bit-reversed number, where "above" is
/// below, sums and products with constants have this effect.
SCARP_FN uint scarp_owen_scramble(uint number, uint seed) {
  uint x = scarp_reverse_bits(number);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return scarp_reverse_bits(x);
}

/// The second dimension's generator matrix is Pascal's triangle modulo 2, column by column.
SCARP_FN uint scarp_sobol_y(uint number) {
  uint y = 0u;
  uint column = 0x80000000u;
  for (uint index = number; index != 0u; index >>= 1) {
    if ((index & 1u) != 0u) y ^= column;
    column ^= column >> 1;
  }
  return y;
}

/// The image of `digit` under a permutation of 0..3 that `random` selects.
SCARP_FN uint scarp_permuted(uint digit, uint random) {
  uint to = 0xe4u;  // 0, 1, 2, 3: two bits each
  for (uint i = 3u; i > 0u; --i) {
    uint j = ((random >> (8u * (3u - i))) & 0xffu) % (i + 1u);
    uint differ = ((to >> (2u * i)) ^ (to >> (2u * j))) & 3u;
    to ^= (differ << (2u * i)) | (differ << (2u * j));
  }
  return (to >> (2u * digit)) & 3u;
}

SCARP_FN ScarpPixelPoints scarp_pixel_points(uint seed, int index_bits, uint x, uint y, uint purpose) {
  uint random = scarp_scatter_two(purpose, seed);
  // Both coordinates in 16 base-4 digits; a digit's permutation depends on the digits above it.
  uint place = 0u;
  uint above = 0u;
  for (uint left = 16u; left > 0u; --left) {
    uint digit = left - 1u;
    uint quarter = ((y >> digit) & 1u) << 1 | ((x >> digit) & 1u);
    place = place << 2 | scarp_permuted(quarter, scarp_scatter(above ^ scarp_scatter_two(random, digit)));
    above = above << 2 | quarter;
  }
  // Beyond 2^32 points the sequence repeats, and so do distant parts of large pictures.
  uint first = place << uint(index_bits);
  ScarpPixelPoints points;
  points.x = scarp_reverse_bits(first);
  points.y = scarp_sobol_y(first);
  points.index_bits = index_bits;
  points.seed_order = scarp_scatter_two(scarp_scatter_two(random, 3u), place);
  points.seed_x = scarp_scatter_two(random, 1u);
  points.seed_y = scarp_scatter_two(random, 2u);
  return points;
}

/// The centre of one of 2^32 parts of 0..1, or of 2^23 in floats: no point is on the square's border, where hemispheres
/// touch the ground.
SCARP_FN real scarp_middle_of_part(uint part) {
#ifdef __cplusplus
  return (part + 0.5) * 0x1p-32;
#else
  return (float(part >> 9) + 0.5) * 1.1920928955078125e-7;
#endif
}

/// Point i.
SCARP_FN real2 scarp_pixel_point(ScarpPixelPoints points, uint i) {
  // A pixel with one point has no bits to shuffle, and a shift by 32 is undefined.
  uint unused = uint(32 - points.index_bits);
  uint at = points.index_bits == 0 ? 0u : scarp_owen_scramble(i << unused, points.seed_order) >> unused;
  // Sobol's points are linear in the bits of their index over xor, so a block's first point is computed only once.
  uint x = points.x ^ scarp_reverse_bits(at);
  uint y = points.y ^ scarp_sobol_y(at);
  return real2(scarp_middle_of_part(scarp_owen_scramble(x, points.seed_x)),
               scarp_middle_of_part(scarp_owen_scramble(y, points.seed_y)));
}

SCARP_GLSL_END

#endif
