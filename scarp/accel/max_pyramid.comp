// SPDX-License-Identifier: MIT
// One level of the maximum and minimum pyramid (max_pyramid.h), bit for bit as the CPU makes it: extremes are compared
// as whole numbers, and codes of float samples come from tables that the CPU's own formula has made, so that no rounding
// of the device takes part. An invocation makes one entry.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/accel/ground_buffers.glsl.h"
#include "scarp/accel/max_pyramid.glsl.h"

layout(local_size_x = kPyramidGroupCols, local_size_y = kPyramidGroupRows) in;
layout(push_constant, scalar) uniform Push { PyramidPush push; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer PyramidEntries { uint words[]; };

// The extremes of some cells as keys, whole numbers in the order of the samples; holes have the key 0 for both, so that
// they raise no maximum and leave no minimum.
struct Extremes {
  uint highest;
  uint lowest;
};

uint key_of(uint type, uint bits) {
  if (type == kGroundFloat32) return float_key(bits);
  return type == kGroundInt16 ? bits ^ 0x8000u : bits;
}

void add_cell(Ground ground, uint col, uint row, inout Extremes extremes) {
  uint east = ground_east(ground, col), south = ground_south(ground, row);
  uvec4 bits = uvec4(ground_sample_bits(ground, col, row), ground_sample_bits(ground, east, row),
                     ground_sample_bits(ground, col, south), ground_sample_bits(ground, east, south));
  if (ground.is.has_holes != 0u && any(equal(bits, uvec4(ground.is.hole)))) {
    extremes.lowest = 0u;
    return;
  }
  uint type = ground.is.sample_type;
  uvec4 keys = uvec4(key_of(type, bits.x), key_of(type, bits.y), key_of(type, bits.z), key_of(type, bits.w));
  extremes.highest = max(extremes.highest, max(max(keys.x, keys.y), max(keys.z, keys.w)));
  extremes.lowest = min(extremes.lowest, min(min(keys.x, keys.y), min(keys.z, keys.w)));
}

uint ceiling(uint code) { return GroundWords(push.codes).words[code]; }
uint floor_of(uint code) { return GroundWords(push.codes).words[kPyramidCodes + code]; }

// The code that a key is likely to have, `beyond` its place; only the tables know.
uint guess_code(Ground ground, uint key, float beyond) {
  float place = (uintBitsToFloat(float_bits(key)) - ground.is.code_base) * ground.is.code_per_step + beyond;
  return min(uint(clamp(place, 0.0, 65535.0)), kPyramidCodes - 1u);
}

// The least code whose ceiling is not below the key.
uint code_above(Ground ground, uint key) {
  uint guess = guess_code(ground, key, 1.0), low = 0u, high = kPyramidCodes - 1u;
  if (key <= ceiling(guess)) {
    if (guess == 0u || key > ceiling(guess - 1u)) return guess;
    high = guess - 1u;
  } else {
    low = guess + 1u;
    if (key <= ceiling(low)) return low;
  }
  while (low < high) {
    uint middle = (low + high) / 2u;
    if (key <= ceiling(middle)) {
      high = middle;
    } else {
      low = middle + 1u;
    }
  }
  return low;
}

// The greatest code whose floor is not above the key.
uint code_below(Ground ground, uint key) {
  uint guess = guess_code(ground, key, 0.0), low = 0u, high = kPyramidCodes - 1u;
  if (key >= floor_of(guess)) {
    if (guess == high || key < floor_of(guess + 1u)) return guess;
    low = guess + 1u;
  } else {
    high = guess - 1u;
    if (key >= floor_of(high)) return high;
  }
  while (low < high) {
    uint middle = (low + high + 1u) / 2u;
    if (key >= floor_of(middle)) {
      low = middle;
    } else {
      high = middle - 1u;
    }
  }
  return low;
}

// Level 1: two cells by two, fewer at an odd end.
uint entry_from_samples(Ground ground, uvec2 at) {
  Extremes extremes = Extremes(0u, 0xffffffffu);
  uvec2 end = min(2u * at + 2u, uvec2(ground.is.cell_cols, ground.is.cell_rows));
  for (uint row = 2u * at.y; row < end.y; ++row) {
    for (uint col = 2u * at.x; col < end.x; ++col) add_cell(ground, col, row, extremes);
  }
  if (ground.is.sample_type == kGroundFloat32) {
    extremes.highest = code_above(ground, extremes.highest);
    extremes.lowest = code_below(ground, extremes.lowest);
  }
  return extremes.highest | extremes.lowest << 16;
}

// Other levels: two entries by two, fewer at an odd end.
uint entry_from_finer(Ground ground, uvec2 at) {
  GroundLevel finer = ground.is.levels[push.level - 2u];
  GroundWords entries = GroundWords(ground.is.pyramid);
  uvec2 first = 2u * at, last = min(first + 1u, uvec2(finer.cols, finer.rows) - 1u);
  uint north = finer.begin + first.y * finer.cols, south = finer.begin + last.y * finer.cols;
  uvec4 four = uvec4(entries.words[north + first.x], entries.words[north + last.x], entries.words[south + first.x],
                     entries.words[south + last.x]);
  uvec4 high = four & 0xffffu, low = four >> 16;
  uint highest = max(max(high.x, high.y), max(high.z, high.w)), lowest = min(min(low.x, low.y), min(low.z, low.w));
  return highest | lowest << 16;
}

void main() {
  uvec2 at = uvec2(push.col_begin, push.row_begin) + gl_GlobalInvocationID.xy;
  if (at.x >= push.col_end || at.y >= push.row_end) return;
  Ground ground = Ground(push.ground);
  GroundLevel level = ground.is.levels[push.level - 1u];
  uint entry = push.level == 1u ? entry_from_samples(ground, at) : entry_from_finer(ground, at);
  PyramidEntries(ground.is.pyramid).words[level.begin + at.y * level.cols + at.x] = entry;
}
