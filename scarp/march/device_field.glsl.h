// SPDX-License-Identifier: MIT
// The ground in a device's memory (accel/ground_buffers.glsl.h) as the marches ask for it (cell_surface.glsl.h,
// max_mip.glsl.h). Who includes it has defined, before, SCARP_GROUND: the address of its GroundBuffers. GLSL alone.
#ifndef SCARP_MARCH_DEVICE_FIELD_GLSL_H
#define SCARP_MARCH_DEVICE_FIELD_GLSL_H

#include "scarp/accel/ground_buffers.glsl.h"
#include "scarp/march/ray_frame.glsl.h"

float scarp_sample(int col, int row) {
  Ground ground = Ground(SCARP_GROUND);
  return ground_sample_value(ground, ground_sample_bits(ground, uint(col), uint(row)));
}

// All nodata floats are stored as one NaN, which is known by its bits: comparisons of NaN are the compiler's.
bool scarp_is_nodata(float value) {
  Ground ground = Ground(SCARP_GROUND);
  if (ground.is.sample_type == kGroundFloat32) return (floatBitsToUint(value) & 0x7fffffffu) > 0x7f800000u;
  return value == ground_sample_value(ground, ground.is.hole);
}

float scarp_maximum(int level, int col, int row) {
  return float(ground_maximum(ground_entry(Ground(SCARP_GROUND), uint(level), uint(col), uint(row))));
}
float scarp_minimum(int level, int col, int row) {
  return float(ground_minimum(ground_entry(Ground(SCARP_GROUND), uint(level), uint(col), uint(row))));
}

ScarpField device_field() {
  Ground ground = Ground(SCARP_GROUND);
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

#endif
