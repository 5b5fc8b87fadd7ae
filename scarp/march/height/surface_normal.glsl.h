// SPDX-License-Identifier: MIT
// Slopes of a height field for shading, in single precision: HeightField::gradient() and shading_normal() for shaders.
// Units are sample units per column (x) and per row (y). Compiles as C++ and GLSL, including GLSL ES 3.0. The including
// file must define what cell_surface.glsl.h requires.
#ifndef SCARP_MARCH_SURFACE_NORMAL_GLSL_H
#define SCARP_MARCH_SURFACE_NORMAL_GLSL_H

#include "scarp/march/height/cell_surface.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Slope of the surface itself, at a position in a cell that is not a hole.
SCARP_FN vec2 scarp_slope(ScarpField field, ivec2 cell, vec2 place) {
  ScarpCell h = scarp_cell(field, cell.x, cell.y, 0.0f);
  if ((field.flags & kScarpTriangles) != 0u) {
    bool south_east = place.x + place.y > 1.0f;
    return south_east ? vec2(h.h11 - h.h01, h.h11 - h.h10) : vec2(h.h10 - h.h00, h.h01 - h.h00);
  }
  float hu = h.h10 - h.h00;
  float hv = h.h01 - h.h00;
  float twist = (h.h11 - h.h01) - hu;
  return vec2(hu + twist * place.y, hv + twist * place.x);
}

/// The sample at a node; false beyond a border and over a hole.
struct ScarpNode {
  bool valid;
  float value;
};
/// The sample at (col, row), which may be beyond the border: a wrapped field continues there.
SCARP_FN ScarpNode scarp_node(ScarpField field, int col, int row) {
  ScarpNode node;
  node.valid = false;
  node.value = 0.0f;
  if ((field.flags & kScarpWraps) != 0u) {
    // A shared border is one node: the node beyond it is the second on the other side.
    if (col < 0 || col >= field.samples.x) col = (col + field.cells.x) % field.cells.x;
    if (row < 0 || row >= field.samples.y) row = (row + field.cells.y) % field.cells.y;
  }
  if (col < 0 || col >= field.samples.x || row < 0 || row >= field.samples.y) return node;
  node.value = scarp_sample(col, row);
  node.valid = !((field.flags & kScarpHoles) != 0u && scarp_is_nodata(node.value));
  return node;
}

/// The difference over the widest span of valid samples around a node.
SCARP_FN float scarp_node_slope(ScarpNode behind, ScarpNode here, ScarpNode ahead) {
  if (!ahead.valid && !behind.valid) return 0.0f;
  float difference = (ahead.valid ? ahead.value : here.value) - (behind.valid ? behind.value : here.value);
  return ahead.valid && behind.valid ? 0.5f * difference : difference;
}

/// Continuous from cell to cell: central differences at the four nodes, interpolated.
SCARP_FN vec2 scarp_shading_slope(ScarpField field, ivec2 cell, vec2 place) {
  vec2 sum = vec2(0.0f, 0.0f);
  // Along the rows and then the columns of nodes through the cell's sides.
  for (int i = 0; i < 4; ++i) {
    int beside = i & 1;
    bool along_row = i < 2;
    ivec2 step = along_row ? ivec2(1, 0) : ivec2(0, 1);
    ivec2 first = along_row ? ivec2(cell.x, cell.y + beside) : ivec2(cell.x + beside, cell.y);
    ScarpNode n0 = scarp_node(field, first.x - step.x, first.y - step.y);
    ScarpNode n1 = scarp_node(field, first.x, first.y);
    ScarpNode n2 = scarp_node(field, first.x + step.x, first.y + step.y);
    ScarpNode n3 = scarp_node(field, first.x + 2 * step.x, first.y + 2 * step.y);
    float across = along_row ? place.y : place.x;
    float along = along_row ? place.x : place.y;
    float slope = (1.0f - along) * scarp_node_slope(n0, n1, n2) + along * scarp_node_slope(n1, n2, n3);
    float weighed = (beside == 0 ? 1.0f - across : across) * slope;
    if (along_row)
      sum.x += weighed;
    else
      sum.y += weighed;
  }
  return sum;
}

SCARP_GLSL_END

#endif
