// SPDX-License-Identifier: MIT
// The ground in two textures, for hosts that have neither buffers nor addresses, such as WebGL 2. What the marches ask
// of their host (cell_surface.glsl.h, max_mip.glsl.h), answered by texelFetch.
//
//   scarp_heights   32-bit float, one channel: texel (col, row) is the sample there
//   scarp_bounds    32-bit float, two channels, with mip levels: texel (col, row) of mip level l - 1 holds the maximum
//                   and the minimum code of block (col, row) of level l, as accel/max_pyramid.h makes them. Its sides
//                   are powers of two no less than those of level 1, so that every level has room; what lies beyond
//                   means nothing
//
// Both with the filters NEAREST, but for the minification of scarp_bounds: NEAREST_MIPMAP_NEAREST, for without a filter
// that knows of mip levels all but the first mean nothing to texelFetch. A host that lets nobody fill mip levels
// (Shadertoy's buffers have none of one's own) puts them beside one another into one level, and writes scarp_maximum
// and scarp_minimum itself.
//
// GLSL, GLSL ES 3.0 included. Who includes it has declared, before,
//   uniform highp sampler2D scarp_heights, scarp_bounds;
//   uniform highp float scarp_nodata;                      value of a hole; NaN is one anyway
#ifndef SCARP_MARCH_TEXTURES_GLSL_H
#define SCARP_MARCH_TEXTURES_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// The sample at a node.
SCARP_FN float scarp_sample(int col, int row) { return texelFetch(scarp_heights, ivec2(col, row), 0).x; }

/// Whether a sample is a hole. NaN is known by its bits: comparisons of NaN are the compiler's.
SCARP_FN bool scarp_is_nodata(float value) {
  return value == scarp_nodata || (floatBitsToUint(value) & 0x7fffffffu) > 0x7f800000u;
}

/// The maximum code of a block, level 1 and up.
SCARP_FN float scarp_maximum(int level, int col, int row) {
  return texelFetch(scarp_bounds, ivec2(col, row), level - 1).x;
}
/// The minimum code; 0 where there is none.
SCARP_FN float scarp_minimum(int level, int col, int row) {
  return texelFetch(scarp_bounds, ivec2(col, row), level - 1).y;
}

SCARP_GLSL_END

#endif
