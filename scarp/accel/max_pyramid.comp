// SPDX-License-Identifier: MIT
// Builds one level of the maximum and minimum pyramid (max_pyramid.h), bit for bit as the CPU does. Extremes are
// compared as integers, and codes of float samples come from tables computed on the CPU, so device rounding does not
// matter. Each invocation writes one entry.
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

// Extremes of some cells as keys: integers in the order of the samples. Holes have key 0 for both, so that they raise
// no maximum and leave no minimum.
struct Extremes {
  uint highest;
  uint lowest;
};

uint key_of(uint type, uint bits) {
  if (type == kGroundFloat32) return float_key(bits);
  return type == kGroundInt16 ? bits ^ 0x8000u : bits;
}

// Three samples of a row as keys.
uvec3 keys_of_row(GroundWords samples, uint type, uint begin, uvec3 col) {
  if (type == kGroundFloat32) {
    return uvec3(key_of(type, samples.words[begin + col.x]), key_of(type, samples.words[begin + col.y]),
                 key_of(type, samples.words[begin + col.z]));
  }
  uvec3 words = uvec3(samples.words[begin + (col.x >> 1)], samples.words[begin + (col.y >> 1)],
                      samples.words[begin + (col.z >> 1)]);
  uvec3 bits = words >> ((col & 1u) * 16u) & 0xffffu;
  return uvec3(key_of(type, bits.x), key_of(type, bits.y), key_of(type, bits.z));
}

void add_cell(uvec2 north, uvec2 south, uint hole, inout Extremes extremes) {
  if (any(equal(north, uvec2(hole))) || any(equal(south, uvec2(hole)))) {
    extremes.lowest = 0u;
    return;
  }
  uvec2 high = max(north, south), low = min(north, south);
  extremes.highest = max(extremes.highest, max(high.x, high.y));
  extremes.lowest = min(extremes.lowest, min(low.x, low.y));
}

uint ceiling(uint code) { return GroundWords(push.codes).words[code]; }
uint floor_of(uint code) { return GroundWords(push.codes).words[kPyramidCodes + code]; }

// Estimates the code of a key, moved by `beyond` codes; the tables determine the exact code.
uint guess_code(Ground ground, uint key, float beyond) {
  float place = (uintBitsToFloat(float_bits(key)) - ground.is.code_base) * ground.is.code_per_step + beyond;
  return min(uint(clamp(place, 0.0, 65535.0)), kPyramidCodes - 1u);
}

// Returns the smallest code whose ceiling is not below the key.
uint code_above(Ground ground, uint key) {
  uint guess = guess_code(ground, key, 1.0), low = 0u, high = kPyramidCodes - 1u;
  if (key <= ceiling(guess)) {
    if (guess == 0u || key > ceiling(guess - 1u)) return guess;
    high = guess - 1u;
    if (high == 0u || key > ceiling(high - 1u)) return high;
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

// Returns the greatest code whose floor is not above the key.
uint code_below(Ground ground, uint key) {
  uint guess = guess_code(ground, key, 0.0), low = 0u, high = kPyramidCodes - 1u;
  if (key >= floor_of(guess)) {
    if (guess == high || key < floor_of(guess + 1u)) return guess;
    low = guess + 1u;
    if (low == high || key < floor_of(low + 1u)) return low;
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

// Level 1: 2 x 2 cells from 3 x 3 samples; fewer at an odd end, where the last two samples coincide.
uint entry_from_samples(Ground ground, uvec2 at) {
  uvec2 first = 2u * at;
  bool wide = first.x + 1u < ground.is.cell_cols, high = first.y + 1u < ground.is.cell_rows;
  uint east = ground_east(ground, first.x), south = ground_south(ground, first.y);
  uvec3 cols = uvec3(first.x, east, wide ? ground_east(ground, east) : east);
  uvec3 rows = uvec3(first.y, south, high ? ground_south(ground, south) : south) * ground.is.sample_words;
  GroundWords samples = GroundWords(ground.is.samples);
  uint type = ground.is.sample_type;
  uvec3 a = keys_of_row(samples, type, rows.x, cols), b = keys_of_row(samples, type, rows.y, cols),
        c = keys_of_row(samples, type, rows.z, cols);
  Extremes extremes = Extremes(0u, 0xffffffffu);
  if (ground.is.has_holes == 0u) {
    uvec3 most = max(max(a, b), c), least = min(min(a, b), c);
    extremes = Extremes(max(max(most.x, most.y), most.z), min(min(least.x, least.y), least.z));
  } else {
    uint hole = key_of(type, ground.is.hole);
    add_cell(a.xy, b.xy, hole, extremes);
    if (wide) add_cell(a.yz, b.yz, hole, extremes);
    if (high) add_cell(b.xy, c.xy, hole, extremes);
    if (wide && high) add_cell(b.yz, c.yz, hole, extremes);
  }
  if (type == kGroundFloat32) {
    extremes.highest = code_above(ground, extremes.highest);
    extremes.lowest = code_below(ground, extremes.lowest);
  }
  return extremes.highest | extremes.lowest << 16;
}

// Other levels: 2 x 2 entries; fewer at an odd end.
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
