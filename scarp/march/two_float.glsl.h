// SPDX-License-Identifier: MIT
// Numbers with twice the precision of a float, as sums of two floats, for the few places where a float is not
// sufficient.
//
//   value = high + low,  |low| <= half a unit in the last place of high: 48 bits
//
// Compiles as C++ and GLSL (scarp/vk/glsl_cpp.h), including GLSL ES 3.0. Source: T. J. Dekker, "A floating-point
// technique for extending the available precision", Numerische Mathematik 18, 1971; D. E. Knuth, TAOCP 2, 4.2.2. No
// fused multiply-add is needed. A compiler that reassociates floating-point sums (as some do for GLSL ES 3.0, which has
// no `precise`) turns low into zero: the result is then that of plain floats.
#ifndef SCARP_MARCH_TWO_FLOAT_GLSL_H
#define SCARP_MARCH_TWO_FLOAT_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// high + low.
struct ScarpTwoFloat {
  float high, low;
};

/// a + b without rounding.
SCARP_FN ScarpTwoFloat scarp_two_sum(float a, float b) {
  SCARP_PRECISE float sum = a + b;
  SCARP_PRECISE float b_part = sum - a;
  SCARP_PRECISE float a_part = sum - b_part;
  SCARP_PRECISE float low = (a - a_part) + (b - b_part);
  ScarpTwoFloat result;
  result.high = sum;
  result.low = low;
  return result;
}

/// The high half of a float: 12 bits, so that products of halves are exact. |a| below 2^115.
SCARP_FN float scarp_high_half(float a) {
  SCARP_PRECISE float scaled = a * 4097.0f;  // 2^12 + 1
  SCARP_PRECISE float rest = scaled - a;
  SCARP_PRECISE float half_a = scaled - rest;
  return half_a;
}

/// a * b without rounding, unless it underflows.
SCARP_FN ScarpTwoFloat scarp_two_product(float a, float b) {
  SCARP_PRECISE float product = a * b;
  float a1 = scarp_high_half(a);
  float b1 = scarp_high_half(b);
  SCARP_PRECISE float a0 = a - a1;
  SCARP_PRECISE float b0 = b - b1;
  SCARP_PRECISE float low = ((a1 * b1 - product) + a1 * b0 + a0 * b1) + a0 * b0;
  ScarpTwoFloat result;
  result.high = product;
  result.low = low;
  return result;
}

/// start + slope * t to about 2^-46 of the largest term; `whole` is added exactly.
SCARP_FN ScarpTwoFloat scarp_two_line(float whole, float start, float start_low, float slope, float slope_low,
                                      float t) {
  ScarpTwoFloat way = scarp_two_product(slope, t);
  ScarpTwoFloat sum = scarp_two_sum(whole, way.high);
  ScarpTwoFloat all = scarp_two_sum(sum.high, start);
  SCARP_PRECISE float low = (sum.low + all.low) + ((way.low + slope_low * t) + start_low);
  return scarp_two_sum(all.high, low);
}

/// Converts a float.
SCARP_FN ScarpTwoFloat scarp_two(float a) {
  ScarpTwoFloat result;
  result.high = a;
  result.low = 0.0f;
  return result;
}
/// -a without rounding.
SCARP_FN ScarpTwoFloat scarp_two_negate(ScarpTwoFloat a) {
  ScarpTwoFloat result;
  result.high = -a.high;
  result.low = -a.low;
  return result;
}
/// a < b, for sums whose low part is within half a unit of the high one (as all functions here return them).
SCARP_FN bool scarp_two_less(ScarpTwoFloat a, ScarpTwoFloat b) {
  return a.high < b.high || (a.high == b.high && a.low < b.low);
}

/// a + b to 2^-46 of |a| + |b|.
SCARP_FN ScarpTwoFloat scarp_two_add(ScarpTwoFloat a, ScarpTwoFloat b) {
  ScarpTwoFloat sum = scarp_two_sum(a.high, b.high);
  SCARP_PRECISE float low = sum.low + (a.low + b.low);
  return scarp_two_sum(sum.high, low);
}
/// a * b with a relative error of at most 2^-45.
SCARP_FN ScarpTwoFloat scarp_two_multiply(ScarpTwoFloat a, ScarpTwoFloat b) {
  ScarpTwoFloat product = scarp_two_product(a.high, b.high);
  SCARP_PRECISE float low = product.low + (a.high * b.low + a.low * b.high);
  return scarp_two_sum(product.high, low);
}
/// k0 a + k1 b + k2 to 2^-44 of |k0 a| + |k1 b| + |k2|.
SCARP_FN ScarpTwoFloat scarp_two_combine(ScarpTwoFloat k0, ScarpTwoFloat a, ScarpTwoFloat k1, ScarpTwoFloat b,
                                         ScarpTwoFloat k2) {
  return scarp_two_add(scarp_two_add(scarp_two_multiply(k0, a), scarp_two_multiply(k1, b)), k2);
}

SCARP_GLSL_END

#endif
