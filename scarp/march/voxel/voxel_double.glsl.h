// SPDX-License-Identifier: MIT
// Rays through voxels in double, with the results of the CPU: quotients, and voxel_quantise.glsl.h. Compiles as C++
// and GLSL with float64.
//
// Drivers divide doubles with errors of a few units. A quotient is corrected until its remainder, an exact integer, is
// less than half the divisor. (A quotient of two integers below 2^53, or of 1 and a double, never lies halfway between
// two doubles.)
#ifndef SCARP_MARCH_VOXEL_DOUBLE_GLSL_H
#define SCARP_MARCH_VOXEL_DOUBLE_GLSL_H

#define scarp_real double
#include "scarp/march/voxel/voxel_quantise.glsl.h"
#include "scarp/march/voxel/voxel_walk.glsl.h"

// A loop that is not unrolled takes fewer registers and instructions. Shaders enable GL_EXT_control_flow_attributes.
#ifdef __cplusplus
#define SCARP_DONT_UNROLL
#else
#define SCARP_DONT_UNROLL [[dont_unroll]]
#endif

SCARP_GLSL_BEGIN

#ifdef __cplusplus
inline uvec2 unpackDouble2x32(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return {static_cast<uint>(bits), static_cast<uint>(bits >> 32)};
}
inline double packDouble2x32(const uvec2& words) {
  return std::bit_cast<double>(std::uint64_t{words.y} << 32 | words.x);
}
#endif

/// Returns the double next to x, away from 0 or towards it. Not for 0.
SCARP_FN double scarp_next_double(double x, bool away) {
  uvec2 words = unpackDouble2x32(x);
  uint low = away ? words.x + 1u : words.x - 1u;
  uint carry = away ? (low == 0u ? 1u : 0u) : (words.x == 0u ? 0xffffffffu : 0u);
  return packDouble2x32(uvec2(low, words.y + carry));
}

/// Returns a / b for a, b > 0, given the low word of a and a quotient that is off by at most 3 units.
SCARP_FN double scarp_corrected_ratio(double ratio, uint a, uint b) {
  SCARP_DONT_UNROLL for (int turn = 0; turn < 4; ++turn) {
    // ratio = mantissa 2^-shift; the remainder a 2^shift - mantissa b fits in a word.
    uvec2 words = unpackDouble2x32(ratio);
    uint shift = 1075u - (words.y >> 20);
    int rest = int((shift < 32u ? a << shift : 0u) - words.x * b);
    if (2 * abs(rest) < int(b)) break;
    ratio = scarp_next_double(ratio, rest > 0);
  }
  return ratio;
}

/// Returns 1 / x for x far from overflow and underflow, given an inverse accurate to 3 units.
SCARP_FN double scarp_corrected_inverse(double inverse, double x) {
  uvec2 of = unpackDouble2x32(x);
  uint divisor_high = (of.y & 0xfffffu) | 0x100000u;
  // Half the mantissa of x, rounded down.
  uvec2 least = uvec2(of.x >> 1 | divisor_high << 31, divisor_high >> 1);
  SCARP_DONT_UNROLL for (int turn = 0; turn < 4; ++turn) {
    // The remainder 2^k - mantissa mantissa_x fits in two words, and 2^k leaves nothing there.
    uvec2 words = unpackDouble2x32(inverse);
    uint mantissa_high = (words.y & 0xfffffu) | 0x100000u;
    uvec2 product = scarp_words_product(words.x, of.x);
    product.y += words.x * divisor_high + mantissa_high * of.x;
    uvec2 rest = scarp_words_minus(uvec2(0u, 0u), product);
    bool below = int(rest.y) < 0;
    uvec2 size = below ? product : rest;
    if (size.y < least.y || (size.y == least.y && size.x <= least.x)) break;
    inverse = scarp_next_double(inverse, !below);
  }
  return inverse;
}

/// Returns a / b for b > 0; a, in two words, is below 2^52.
SCARP_FN double scarp_exact_ratio(uvec2 a, uint b) {
  if ((a.x | a.y) == 0u) return double(0.0f);
  return scarp_corrected_ratio((double(a.y) * double(4294967296.0f) + double(a.x)) / double(b), a.x, b);
}

/// Returns 1 / x, and infinity with the sign of x for 0.
SCARP_FN double scarp_exact_inverse(double x) {
  if (x == double(0.0f)) return packDouble2x32(uvec2(0u, 0x7ff00000u | (unpackDouble2x32(x).y & 0x80000000u)));
  return scarp_corrected_inverse(double(1.0f) / x, x);
}

/// The time at the current voxel, given that at the entry into the box.
SCARP_FN double scarp_voxel_time(ScarpVoxelWalk walk, double t_entered, double t_per_s) {
  SCARP_PRECISE double t = t_entered;
  if (walk.axis >= 0) {
    double ratio = scarp_exact_ratio(scarp_voxel_distance(walk), walk.speed[walk.axis]);
    SCARP_PRECISE double later = ratio * t_per_s;
    t = t_entered + later;
  }
  return t;
}

/// A component of grid_from_world * v, given its row.
SCARP_FN double scarp_turned(dvec3 row, dvec3 v) {
  SCARP_PRECISE double x = row.x * v.x;
  SCARP_PRECISE double y = row.y * v.y;
  SCARP_PRECISE double xy = x + y;
  SCARP_PRECISE double z = row.z * v.z;
  SCARP_PRECISE double sum = xy + z;
  return sum;
}

/// VoxelRay::room of a ray with Ray::room, in a grid with this many voxels per metre.
SCARP_FN double scarp_voxel_room(double own, double per_metre, uint room) {
  SCARP_PRECISE double placed = packDouble2x32(uvec2(0u, room << 16)) * per_metre;
  return own < placed ? placed : own;
}

SCARP_GLSL_END

#endif
