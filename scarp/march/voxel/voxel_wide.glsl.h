// SPDX-License-Identifier: MIT
// The arithmetic of voxel marches that takes more than 32 bits: the order of planes, and planes before an exit.
//
// Each product has two forms with identical results: one 64-bit integer, or two 32-bit words for devices without
// shaderInt64. The host defines
//
//   bool scarp_voxel_words();   // whether to use words; constant, so that compilers drop the other form
//
// and shaders with 64-bit integers define SCARP_INT64. Compiles as C++ and GLSL, including GLSL ES 3.0.
//
// Distances are at most 2^31 and speeds at most 2^28, so products are below 2^60.
#ifndef SCARP_MARCH_VOXEL_WIDE_GLSL_H
#define SCARP_MARCH_VOXEL_WIDE_GLSL_H

#include "scarp/vk/glsl_cpp.h"

#ifdef __cplusplus
#define SCARP_INT64
#endif

SCARP_GLSL_BEGIN

#ifdef __cplusplus
inline void umulExtended(uint a, uint b, uint& high, uint& low) {
  const std::uint64_t product = std::uint64_t{a} * b;
  high = static_cast<uint>(product >> 32);
  low = static_cast<uint>(product);
}
bool scarp_voxel_words();
#endif

// GLSL ES 3.0 and GLSL 3.30 lack this function.
#ifndef __cplusplus
#if __VERSION__ < 310 || (!defined(GL_ES) && __VERSION__ < 400)
void umulExtended(uint a, uint b, out uint high, out uint low) {
  uint a0 = a & 0xffffu, a1 = a >> 16, b0 = b & 0xffffu, b1 = b >> 16;
  uint middle = a1 * b0 + (a0 * b0 >> 16);
  uint carried = a0 * b1 + (middle & 0xffffu);
  high = a1 * b1 + (middle >> 16) + (carried >> 16);
  low = a * b;
}
#endif
#endif

const uint kScarpVoxelPlaces = 1u << 20;  ///< kVoxelPlaces: positions per voxel
const uint kScarpNoPlane = 0x80000000u;   ///< distance to planes along an axis of speed 0: any number above 0

/// Two words, the low one first.
SCARP_FN uvec2 scarp_words_product(uint a, uint b) {
  uint high, low;
  umulExtended(a, b, high, low);
  return uvec2(low, high);
}
/// Returns a - b.
SCARP_FN uvec2 scarp_words_minus(uvec2 a, uvec2 b) { return uvec2(a.x - b.x, a.y - b.y - (a.x < b.x ? 1u : 0u)); }
/// Returns a + b.
SCARP_FN uvec2 scarp_words_plus(uvec2 a, uint b) { return uvec2(a.x + b, a.y + (a.x + b < b ? 1u : 0u)); }

/// Returns whether plane a comes before plane b: distance_a / speed_a < distance_b / speed_b, or equal if `ties` is 1.
SCARP_FN bool scarp_plane_before(uint distance_a, uint speed_a, uint distance_b, uint speed_b, uint ties) {
#ifdef SCARP_INT64
  if (!scarp_voxel_words())
    return uint64_t(distance_a) * uint64_t(speed_b) < uint64_t(distance_b) * uint64_t(speed_a) + uint64_t(ties);
#endif
  uvec2 a = scarp_words_product(distance_a, speed_b);
  uvec2 b = scarp_words_plus(scarp_words_product(distance_b, speed_a), ties);
  return a.y != b.y ? a.y < b.y : a.x < b.x;
}

/// Returns the number of planes next / other, (next + 2^20) / other, ... that come no later than distance / speed; if
/// `after` is 1, those at the same position come later. `slowness` is 1 / speed. There are fewer than 2^9.
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
  // The product is off by less than 2^32 * 2^-21. One correction leaves an error of 1.
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

SCARP_GLSL_END

#endif
