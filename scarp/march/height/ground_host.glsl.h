// SPDX-License-Identifier: MIT
// The functions that the marches require of their host (cell_surface.glsl.h, max_mip.glsl.h), implemented with
// accel/ground_buffers.glsl.h. GLSL. Including files call open_ground() before a march. It reads everything that all
// samples share once, because drivers do not move loads through an address out of loops
// (test/march/height/turn_loads_test.cpp counts them). Files with a constant sample type define SCARP_GROUND_TYPE.
#ifndef SCARP_MARCH_GROUND_HOST_GLSL_H
#define SCARP_MARCH_GROUND_HOST_GLSL_H

#include "scarp/accel/ground_buffers.glsl.h"
#include "scarp/march/height/ray_frame.glsl.h"

Address opened_ground, opened_samples, opened_pyramid, opened_quads;
uint opened_words, opened_type;
uint opened_quad_cols, opened_quad_rows, opened_quad_stride;
float opened_hole;

#ifndef SCARP_GROUND_TYPE
#define SCARP_GROUND_TYPE opened_type
#endif

/// Returns the ground at an address, in the form of the marches.
ScarpField open_ground(Address address) {
  Ground ground = Ground(address);
  opened_ground = address;
  opened_samples = ground.is.samples;
  opened_pyramid = ground.is.pyramid;
  opened_quads = ground.is.quads;
  opened_words = ground.is.sample_words;
  opened_quad_cols = ground.is.quad_cols;
  opened_quad_rows = ground.is.quad_rows;
  opened_quad_stride = ground.is.quad_stride;
  opened_type = ground.is.sample_type;
  opened_hole = ground_sample_value(ground, ground.is.hole);
  ScarpField field;
  field.cells = ivec2(ground.is.cell_cols, ground.is.cell_rows);
  field.samples = ivec2(ground.is.cols, ground.is.rows);
  field.top_level = int(ground.is.top_level);
  field.flags = (ground.is.triangles != 0u ? kScarpTriangles : 0u) | (ground.is.has_holes != 0u ? kScarpHoles : 0u) |
                (ground.is.wrap != kGroundWrapNone ? kScarpWraps : 0u) | (ground.is.solid != 0u ? kScarpSolid : 0u);
  field.code_base = ground.is.code_base;
  field.code_base_low = ground.is.code_base_low;
  field.code_step = ground.is.code_step;
  field.lowest = ground.is.min_sample;
  field.highest = ground.is.max_sample;
  return field;
}

float scarp_sample(int col, int row) {
  GroundWords samples = GroundWords(opened_samples);
  uint begin = uint(row) * opened_words;
  if (SCARP_GROUND_TYPE == kGroundFloat32) return uintBitsToFloat(samples.words[begin + uint(col)]);
  uint word = samples.words[begin + (uint(col) >> 1)];
  if (SCARP_GROUND_TYPE == kGroundInt16) return float(bitfieldExtract(int(word), (col & 1) << 4, 16));
  return float(bitfieldExtract(word, (col & 1) << 4, 16));
}

/// The samples of a cell, by rows.
vec4 scarp_corners(int col, int row) {
  if (SCARP_GROUND_TYPE != kGroundFloat32) {
    return vec4(scarp_sample(col, row), scarp_sample(col + 1, row), scarp_sample(col, row + 1),
                scarp_sample(col + 1, row + 1));
  }
  GroundWords samples = GroundWords(opened_samples);
  uint north = uint(row) * opened_words + uint(col);
  uint south = north + opened_words;
  uvec2 north_pair = uvec2(samples.words[north], samples.words[north + 1u]);
  uvec2 south_pair = uvec2(samples.words[south], samples.words[south + 1u]);
  return uintBitsToFloat(uvec4(north_pair, south_pair));
}

// All nodata floats are stored as one NaN, recognised by its bits: compilers may optimise comparisons of NaN.
bool scarp_is_nodata(float value) {
  if (SCARP_GROUND_TYPE == kGroundFloat32) return (floatBitsToUint(value) & 0x7fffffffu) > 0x7f800000u;
  return value == opened_hole;
}

uint pyramid_entry(int level, int col, int row) {
  GroundLevel at = Ground(opened_ground).is.levels[level - 1];
  return GroundWords(opened_pyramid).words[at.begin + uint(row) * at.cols + uint(col)];
}
float scarp_maximum(int level, int col, int row) { return float(ground_maximum(pyramid_entry(level, col, row))); }
uvec2 scarp_quad(int level, int col, int row) {
  uint index = ground_quad(opened_quad_cols, opened_quad_rows, opened_quad_stride, uint(level), uint(col), uint(row));
  return GroundQuads(opened_quads).of[index];
}
float scarp_minimum(int level, int col, int row) { return float(ground_minimum(pyramid_entry(level, col, row))); }

#endif
