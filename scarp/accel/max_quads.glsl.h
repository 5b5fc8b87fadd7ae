// SPDX-License-Identifier: MIT
// Shared by max_quads.comp and the C++ code that dispatches it: maximum codes of single cells, which only devices keep.
#ifndef SCARP_ACCEL_MAX_QUADS_GLSL_H
#define SCARP_ACCEL_MAX_QUADS_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Push constants of max_quads.comp.
struct QuadsPush {
  Address ground;  // GroundBuffers
  Address spread;  // GroundBuffers::spread
  uint level;      // level to build; 1 reads the samples, others the next finer level
  uint col_begin;  // quads [col_begin, col_end) x [row_begin, row_end)
  uint row_begin;
  uint col_end;
  uint row_end;
};

// Error of a height in floats, in codes: 4 roundings of at most 2^17 codes.
const float kQuadRounding = 0.03125f;
// Factor that covers the rounding of a difference of two floats.
const float kReliefRounding = 1.0f + 2.384185791015625e-7f;  // 2^-22

/// Lowest code not below a height, in floats. A code of 65535 stands for the highest sample, regardless of rounding.
SCARP_FN uint scarp_code_above(float height, float code_base, float code_base_low, float code_per_step) {
  float code = ceil(((height - code_base) - code_base_low) * code_per_step + kQuadRounding);
  return uint(clamp(code, 0.0f, 65535.0f));
}

SCARP_GLSL_END

#endif
