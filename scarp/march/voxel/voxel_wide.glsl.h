// SPDX-License-Identifier: MIT
// The arithmetic of voxel marches that takes more than 32 bits: the order of planes, planes before an exit, quotients.
//
// Each product has two forms with identical results: one 64-bit integer, or two 32-bit words for devices without
// shaderInt64. The host defines
//
//   bool scarp_voxel_words();   // whether to use words; constant, so that compilers drop the other form
//
// and shaders with 64-bit integers define SCARP_INT64. Text of C++ and of GLSL.
//
// Distances are at most 2^31 and speeds at most 2^28, so products are below 2^60.
#ifndef SCARP_MARCH_VOXEL_WIDE_GLSL_H
#define SCARP_MARCH_VOXEL_WIDE_GLSL_H

#include "scarp/vk/glsl_cpp.h"

// A loop that is run as such takes fewer registers and instructions. Shaders enable GL_EXT_control_flow_attributes.
#ifdef __cplusplus
#define SCARP_INT64
#define SCARP_DONT_UNROLL
#else
#define SCARP_DONT_UNROLL [[dont_unroll]]
#endif

SCARP_GLSL_BEGIN

#ifdef __cplusplus
inline void umulExtended(uint a, uint b, uint& high, uint& low) {
  const std::uint64_t product = std::uint64_t{a} * b;
  high = static_cast<uint>(product >> 32);
  low = static_cast<uint>(product);
}
inline uvec2 unpackDouble2x32(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return {static_cast<uint>(bits), static_cast<uint>(bits >> 32)};
}
inline double packDouble2x32(const uvec2& words) {
  return std::bit_cast<double>(std::uint64_t{words.y} << 32 | words.x);
}
bool scarp_voxel_words();
#endif

const uint kScarpVoxelPlaces = 1u << 20;  ///< kVoxelPlaces: positions per voxel
const uint kScarpNever = 0x80000000u;     ///< distance to planes along an axis of speed 0: any number above 0

/// Two words, the low one first.
SCARP_FN uvec2 scarp_words_product(uint a, uint b) {
  uint high, low;
  umulExtended(a, b, high, low);
  return uvec2(low, high);
}
SCARP_FN uvec2 scarp_words_minus(uvec2 a, uvec2 b) { return uvec2(a.x - b.x, a.y - b.y - (a.x < b.x ? 1u : 0u)); }
SCARP_FN uvec2 scarp_words_plus(uvec2 a, uint b) { return uvec2(a.x + b, a.y + (a.x + b < b ? 1u : 0u)); }

/// Returns whether plane a comes before plane b: distance_a / speed_a < distance_b / speed_b.
SCARP_FN bool scarp_plane_before(uint distance_a, uint speed_a, uint distance_b, uint speed_b) {
#ifdef SCARP_INT64
  if (!scarp_voxel_words()) return uint64_t(distance_a) * uint64_t(speed_b) < uint64_t(distance_b) * uint64_t(speed_a);
#endif
  uvec2 a = scarp_words_product(distance_a, speed_b), b = scarp_words_product(distance_b, speed_a);
  return a.y != b.y ? a.y < b.y : a.x < b.x;
}

/// Returns the number of planes next / other, (next + 2^20) / other, ... that come no later than distance / speed; if
/// `after` is 1, those at the same place come later. `slowness` is 1 / speed. There are less than 2^9.
SCARP_FN uint scarp_planes_until(uint distance, uint speed, float slowness, uint next, uint other, uint after) {
  // (distance other - next speed - after) / 2^20, rounded down: below 2^40.
  uint low = 0u, high = 0u;
  bool any = false, words = true;
#ifdef SCARP_INT64
  words = scarp_voxel_words();
  if (!words) {
    int64_t ahead =
        int64_t(uint64_t(distance) * uint64_t(other)) - int64_t(uint64_t(next) * uint64_t(speed)) - int64_t(after);
    any = ahead >= int64_t(0);
    low = uint(ahead >> 20);
    high = uint(ahead >> 52);
  }
#endif
  if (words) {
    uvec2 ahead = scarp_words_minus(
        scarp_words_minus(scarp_words_product(distance, other), scarp_words_product(next, speed)), uvec2(after, 0u));
    any = int(ahead.y) >= 0;
    low = ahead.x >> 20 | ahead.y << 12;
    high = ahead.y >> 20;
  }
  // The quotient is below 2^9 and off by less than 2^9 * 2^-21, so the remainder fits in one word.
  uint planes = uint(any ? (float(high) * 4294967296.0f + float(low)) * slowness : 0.0f);
  int rest = int(low - planes * speed);
  planes += 1u - (rest < 0 ? 1u : 0u) + (rest >= int(speed) ? 1u : 0u);
  return any ? planes : 0u;
}

/// Returns distance * 2^28 / speed, rounded down, if that is below 2^32.
SCARP_FN uint scarp_travelled(uint distance, uint speed, float slowness) {
  if (speed == 1u << 28) return distance;
  uint travelled = uint(float(distance) * slowness * 268435456.0f);
  // That is off by less than 2^32 * 2^-21. One correction leaves an error of 1.
  uvec2 rest = scarp_words_minus(uvec2(distance << 28, distance >> 4), scarp_words_product(travelled, speed));
  int more = int(floor((float(int(rest.y)) * 4294967296.0f + float(rest.x)) * slowness));
  travelled += uint(more);
  int left = int(rest.x - uint(more) * speed);
  return travelled - (left < 0 ? 1u : 0u) + (left >= int(speed) ? 1u : 0u);
}

/// Returns the number of planes next / speed, (next + 2^20) / speed, ... that come before until / 2^28.
SCARP_FN uint scarp_planes_before(uint until, uint next, uint speed) {
  // (until speed - next 2^28 - 1) / 2^48, rounded down.
#ifdef SCARP_INT64
  if (!scarp_voxel_words()) {
    int64_t ahead = int64_t(uint64_t(until) * uint64_t(speed)) - (int64_t(next) << 28) - int64_t(1);
    return ahead < int64_t(0) ? 0u : uint(ahead >> 48) + 1u;
  }
#endif
  uvec2 ahead = scarp_words_minus(scarp_words_minus(scarp_words_product(until, speed), uvec2(next << 28, next >> 4)),
                                  uvec2(1u, 0u));
  return int(ahead.y) < 0 ? 0u : (ahead.y >> 16) + 1u;
}

// Quotients in double, rounded as on the CPU: drivers divide doubles with errors of some units. A quotient is corrected
// until its remainder, an exact integer, is less than half the divisor. (A quotient of two integers below 2^53, or of 1
// and a double, never lies halfway between two doubles.)

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

/// Returns 1 / x for x whose exponent is far from those where doubles end, given an inverse that is off by at most 3
/// units.
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

SCARP_GLSL_END

#endif
