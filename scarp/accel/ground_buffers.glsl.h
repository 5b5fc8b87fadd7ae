// SPDX-License-Identifier: MIT
// Layout of a height field and its pyramid in device memory, written by DeviceGround (device_ground.h) and read by
// shaders. Everything is reached from the address of a GroundBuffers:
//
//   GroundBuffers ──samples──▶ words, rows from north to south, sample_words per row; a word is one float32 sample
//         │                    or two 16-bit samples, the lower half first; the last half of an odd row is undefined
//         ├──pyramid──▶ one word per block: maximum code | minimum code << 16; the entry of block (col, row) of a
//         │             level is levels[level - 1].begin + row * cols + col, level 1 .. top_level, as in MaxPyramid
//         └──quads────▶ two words per block: the maximum codes of its 2 x 2 children, see ground_quad()
//
// Codes equal those of MaxPyramid bit for bit: height = base + step * code, maxima rounded up, minima down. Minimum 0
// means none (a hole, or the lowest code). For 16-bit samples base (-32768 or 0) and step (1) are exact. If has_holes,
// a sample whose bits are `hole` is a hole: all nodata floats, including NaN, are stored as one NaN.
//
// Shaders that include this file enable GL_GOOGLE_include_directive, GL_EXT_scalar_block_layout,
// GL_EXT_buffer_reference and GL_EXT_buffer_reference_uvec2. It requires neither 64-bit integers nor 16-bit types.
#ifndef SCARP_ACCEL_GROUND_BUFFERS_GLSL_H
#define SCARP_ACCEL_GROUND_BUFFERS_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// Values of GroundBuffers::sample_type, equal to SampleType.
const uint kGroundInt16 = 0u;
const uint kGroundUint16 = 1u;
const uint kGroundFloat32 = 2u;

// Values of GroundBuffers::wrap, equal to Wrap.
const uint kGroundWrapNone = 0u;
const uint kGroundWrapPeriodic = 1u;
const uint kGroundWrapSharedBorder = 2u;

// Height equivalent of a float walk's sideways error, per height difference within a cell (doc/dev/numerics.md, "The
// lean pass"): 2^-19.
const float kGroundSpread = 1.9073486328125e-6f;

// Number of levels of the largest field that 31 bits can index.
const uint kGroundMaxLevels = 31u;

/// Position and size of a pyramid level.
struct GroundLevel {
  uint begin;  // first entry, in words from the start of level 1
  uint cols;
  uint rows;
};

/// Layout and properties of a height field in device memory.
struct GroundBuffers {
  Address samples;
  Address pyramid;
  Address quads;
  uint quad_cols;  // of level 1
  uint quad_rows;
  uint quad_stride;
  uint cols;  // samples
  uint rows;
  uint cell_cols;  // cols - 1, or cols if the last column is followed by the first
  uint cell_rows;
  uint sample_words;  // words per row of samples
  uint sample_type;
  uint has_holes;  // 0 or 1
  uint hole;       // bits of a nodata sample
  uint triangles;  // 0: bilinear; 1: two triangles per cell
  uint wrap;
  uint solid;      // 0 or 1
  uint top_level;  // 0: no cells, no pyramid
  // height = (code_base + code_base_low) + (code_step + code_step_low) * code in sample units. Each sum of two floats
  // is accurate to 2^-48 of its magnitude.
  float code_base;
  float code_base_low;
  float code_step;
  float code_step_low;
  float code_per_step;  // 1 / step, rounded
  float code_over;      // a code above the highest sample
  float min_sample;     // of the current samples; undefined if all samples are nodata
  float max_sample;
  float spread;  // kGroundSpread times the largest height difference within a cell, rounded up
  float cell_x;  // metres, rounded
  float cell_y;
  float metres_per_sample;  // scale * exaggeration, rounded
  float metres_at_zero;     // world z of sample value 0, rounded
  GroundLevel levels[kGroundMaxLevels];
};

// Quads are stored in rows of ground_quad_stride() quads: level 1 first, then the other levels side by side.
SCARP_FN uint ground_quad_stride(uint level_1_cols, uint top_level) { return level_1_cols + top_level; }

/// Index of the quad of block (col, row) of a level, 1 .. top_level. Each level starts beyond the columns of all
/// coarser ones: level l has at most (level_1_cols >> (l - 1)) + 1 columns.
SCARP_FN uint ground_quad(uint level_1_cols, uint level_1_rows, uint stride, uint level, uint col, uint row) {
  uint begin = level_1_rows * stride + level_1_cols - (level_1_cols >> (level - 2u)) + (level - 2u);
  return row * stride + col + (level == 1u ? 0u : begin);
}

#ifndef __cplusplus

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer GroundQuads { uvec2 of[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer GroundWords { uint words[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Ground { GroundBuffers is; };

// Returns the 16 or 32 bits of a sample, which must exist.
uint ground_sample_bits(Ground ground, uint col, uint row) {
  GroundWords samples = GroundWords(ground.is.samples);
  uint begin = row * ground.is.sample_words;
  if (ground.is.sample_type == kGroundFloat32) return samples.words[begin + col];
  uint word = samples.words[begin + (col >> 1)];
  return (col & 1u) != 0u ? word >> 16 : word & 0xffffu;
}

// Returns whether a sample is nodata, from its bits.
bool ground_is_nodata(Ground ground, uint bits) { return ground.is.has_holes != 0u && bits == ground.is.hole; }

// Returns the value of a sample in sample units, from its bits; exact.
float ground_sample_value(Ground ground, uint bits) {
  if (ground.is.sample_type == kGroundFloat32) return uintBitsToFloat(bits);
  return ground.is.sample_type == kGroundInt16 ? float(bitfieldExtract(int(bits), 0, 16)) : float(bits);
}

// Returns the column to the east; wraps around after the last one.
uint ground_east(Ground ground, uint col) { return col + 1u < ground.is.cols ? col + 1u : 0u; }
// Returns the row to the south; wraps around after the last one.
uint ground_south(Ground ground, uint row) { return row + 1u < ground.is.rows ? row + 1u : 0u; }

// The four samples of a cell, in sample units: x at (col, row), y at (col+1, row), z at (col, row+1), w at (col+1,
// row+1). Returns false for a hole; the values are then undefined.
bool ground_cell(Ground ground, uint col, uint row, out vec4 heights) {
  uint east = ground_east(ground, col), south = ground_south(ground, row);
  uvec4 bits = uvec4(ground_sample_bits(ground, col, row), ground_sample_bits(ground, east, row),
                     ground_sample_bits(ground, col, south), ground_sample_bits(ground, east, south));
  heights = vec4(ground_sample_value(ground, bits.x), ground_sample_value(ground, bits.y),
                 ground_sample_value(ground, bits.z), ground_sample_value(ground, bits.w));
  return !(ground_is_nodata(ground, bits.x) || ground_is_nodata(ground, bits.y) || ground_is_nodata(ground, bits.z) ||
           ground_is_nodata(ground, bits.w));
}

// Returns the entry of a pyramid block, level 1 .. top_level: maximum code | minimum code << 16.
uint ground_entry(Ground ground, uint level, uint col, uint row) {
  GroundLevel at = ground.is.levels[level - 1u];
  return GroundWords(ground.is.pyramid).words[at.begin + row * at.cols + col];
}
// Returns the maximum code of an entry.
uint ground_maximum(uint entry) { return entry & 0xffffu; }
// Returns the minimum code of an entry; 0 means none.
uint ground_minimum(uint entry) { return entry >> 16; }

#endif

SCARP_GLSL_END

#endif
