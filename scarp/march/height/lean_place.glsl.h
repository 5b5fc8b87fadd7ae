// SPDX-License-Identifier: MIT
// Position of a ray at the start of a frame, for the lean passes of devices (max_mip_lean.glsl.h,
// height_marches_lean.glsl.h): from the ray's own numbers at time s0 in twice float precision, in few instructions.
// Errors: doc/dev/numerics.md, "The lean pass".
//
// Compiles as C++ and GLSL.
#ifndef SCARP_MARCH_LEAN_PLACE_GLSL_H
#define SCARP_MARCH_LEAN_PLACE_GLSL_H

#include "scarp/march/height/ray_frame.glsl.h"
#include "scarp/march/two_float.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Numbers of a field for the lean pass of max-mip, beside ScarpField; from GroundBuffers.
struct ScarpLeanCodes {
  float per_step;  ///< 1 / ScarpField::code_step
  float over;      ///< a code above the highest sample
  float spread;    ///< kGroundSpread (ground_buffers.glsl.h) times the largest height difference within a cell
};

/// Bits of a frame's time, except over fields that wrap: the high 16. Times are below 2^17, so the remainder is less
/// than 2.
const uint kScarpFrameBits = 0xffffff00u;
/// a * s0 as two floats, with a relative error of 2^-31: s0 has 16 bits, so its product with the high 8 bits of `a` is
/// exact.
SCARP_FN ScarpTwoFloat scarp_lean_product(float a, float s0, bool wraps) {
  if (wraps) return scarp_two_product(a, s0);
  float high = uintBitsToFloat(floatBitsToUint(a) & 0xffff0000u);
  ScarpTwoFloat product;
  product.high = high * s0;
  product.low = (a - high) * s0;
  return product;
}

/// A position along an axis: a cell of the grid, and 0..1 in it.
struct ScarpLeanAxis {
  int cell;
  float place;
};

/// The position of the ray at time s0.
SCARP_FN ScarpLeanAxis scarp_lean_axis(int cell, float place, float place_low, float direction, float direction_low,
                                       float s0, int cells, bool wraps) {
  ScarpTwoFloat way = scarp_lean_product(direction, s0, wraps);
  float whole = floor(way.high);
  ScarpLeanAxis found;
  SCARP_PRECISE float rest = (way.high - whole) + (way.low + (place + (direction_low * s0 + place_low)));
  int from = cell + int(whole);
  // A ray that starts on a line belongs to its given cell.
  int to = s0 == 0.0f ? from : from + int(floor(rest));
  // Times are rounded: a ray at the border could be beyond it.
  found.cell = wraps ? to : clamp(to, 0, cells - 1);
  found.place = clamp(rest - float(found.cell - from), 0.0f, 1.0f);
  if (wraps) {
    // The border ahead stays ahead, so that everything before it is tested, except for rays that start on it.
    if (s0 > 0.0f) found.place = clamp(found.place, kScarpUnit, 1.0f - kScarpUnit);
    found.cell -= int(floor(float(found.cell) / float(cells))) * cells;
    // The quotient is rounded.
    if (found.cell < 0) found.cell += cells;
    if (found.cell >= cells) found.cell -= cells;
  }
  return found;
}

/// Height of a ray at time s0, from its height at its start, as two floats.
SCARP_FN ScarpTwoFloat scarp_lean_height(float z, float z_low, float direction, float direction_low, float s0,
                                         bool wraps) {
  ScarpTwoFloat rise = scarp_lean_product(direction, s0, wraps);
  ScarpTwoFloat high = scarp_two_sum(z, rise.high);
  SCARP_PRECISE float low = high.low + (rise.low + (direction_low * s0 + z_low));
  SCARP_PRECISE float base = high.high + low;
  SCARP_PRECISE float left = low - (base - high.high);
  ScarpTwoFloat height;
  height.high = base;
  height.low = left;
  return height;
}

SCARP_GLSL_END

#endif
