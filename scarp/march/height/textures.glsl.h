// SPDX-License-Identifier: MIT
// The ground in two textures, for hosts without buffers and addresses, such as WebGL 2. Implements the functions that
// the marches require of their host (cell_surface.glsl.h, max_mip.glsl.h) with texelFetch.
//
//   scarp_heights   32-bit float, one channel: texel (col, row) is the sample there
//   scarp_bounds    32-bit float, two channels, with mip levels: texel (col, row) of mip level l - 1 holds the maximum
//                   and the minimum code of block (col, row) of level l, as accel/max_pyramid.h makes them. Its sides
//                   are powers of two, at least as large as those of level 1, so that every level fits; texels
//                   beyond are unused
//
// Both use NEAREST filters, except for the minification of scarp_bounds: NEAREST_MIPMAP_NEAREST, because without a
// mipmap filter texelFetch reads only the first level. Hosts that cannot fill mip levels (Shadertoy) place them side by
// side in one level, and implement scarp_maximum and scarp_minimum themselves.
//
// GLSL, including GLSL ES 3.0. Before including this file, declare:
//   uniform highp sampler2D scarp_heights, scarp_bounds;
//   uniform highp float scarp_nodata;                      value of a hole; NaN always marks a hole
#ifndef SCARP_MARCH_TEXTURES_GLSL_H
#define SCARP_MARCH_TEXTURES_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// The sample at a node.
SCARP_FN float scarp_sample(int col, int row) { return texelFetch(scarp_heights, ivec2(col, row), 0).x; }

/// Whether a sample is a hole. NaN is recognised by its bits: compilers may optimise comparisons of NaN.
SCARP_FN bool scarp_is_nodata(float value) {
  return value == scarp_nodata || (floatBitsToUint(value) & 0x7fffffffu) > 0x7f800000u;
}

/// The maximum code of a block, level 1 and up.
SCARP_FN float scarp_maximum(int level, int col, int row) {
  return texelFetch(scarp_bounds, ivec2(col, row), level - 1).x;
}
/// The minimum code; 0 if there is none.
SCARP_FN float scarp_minimum(int level, int col, int row) {
  return texelFetch(scarp_bounds, ivec2(col, row), level - 1).y;
}

SCARP_GLSL_END

#endif
