// The shadow map of a field of heights: one invocation per cell, a ray from the middle of the cell to the sun.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer Heights { float heights[]; };  // rows of samples
layout(std430, binding = 1) readonly buffer Maxima { float maxima[]; };  // codes: level 1, level 2, ...: rows of blocks
layout(std430, binding = 2) writeonly buffer Shadows { uint shadows[]; };  // rows of cells: 1 where the sun is hidden
layout(push_constant) uniform Push {
  int cells;  // per side; there is one more sample
  int top_level;
  float lowest, highest, code_step;
  vec3 sun;
};

// Defined by the host program: access to the samples and to the pyramid's codes.
float scarp_sample(int col, int row) { return heights[row * (cells + 1) + col]; }
bool scarp_is_nodata(float height) { return false; }
float scarp_maximum(int level, int col, int row) {
  int begin = 0, side = (cells + 1) / 2;
  for (int finer = 1; finer < level; ++finer) {
    begin += side * side;
    side = (side + 1) / 2;
  }
  return maxima[begin + row * side + col];
}
float scarp_minimum(int level, int col, int row) { return 0.0; }  // none here

#include "scarp/march/height/float_ray.glsl.h"
#include "scarp/march/height/max_mip.glsl.h"

void main() {
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (cell.x >= cells || cell.y >= cells) return;
  ScarpField field;
  field.cells = ivec2(cells, cells);
  field.samples = ivec2(cells + 1, cells + 1);
  field.top_level = top_level;
  field.flags = 0u;
  field.code_base = 0.0;
  field.code_base_low = 0.0;
  field.code_step = code_step;
  field.lowest = lowest;
  field.highest = highest;
  // The ray starts on the surface: no offset is needed, and the ground does not shadow itself.
  ScarpRay ray = scarp_ray(cell, vec2(0.5, 0.5), 0.0, sun, kScarpNever, kScarpOnSurface);
  shadows[cell.y * cells + cell.x] = scarp_max_mip(field, ray, true).status == kScarpHit ? 1u : 0u;
}
