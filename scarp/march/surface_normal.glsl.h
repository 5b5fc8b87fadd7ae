// SPDX-License-Identifier: MIT
// Slopes of a height field for shading, in single precision: HeightField::gradient() and shading_normal() for shaders.
// In sample units per column (x) and per row (y). Text of C++ and of GLSL, GLSL ES 3.0 included; who includes it has
// defined what cell_surface.glsl.h asks for.
#ifndef SCARP_MARCH_SURFACE_NORMAL_GLSL_H
#define SCARP_MARCH_SURFACE_NORMAL_GLSL_H

#include "scarp/march/cell_surface.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Of the surface itself, at a place in a cell that is no hole.
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

/// The sample at a node, or nothing beyond a border and over a hole.
struct ScarpNode {
  bool valid;
  float value;
};
SCARP_FN ScarpNode scarp_node(ScarpField field, int col, int row) {
  ScarpNode node;
  node.valid = false;
  node.value = 0.0f;
  if ((field.flags & kScarpWraps) != 0u) {
    // A shared border is one node: the one beyond it is the second of the other side.
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
  // Rows and columns of nodes round the cell, but for the four corners.
  for (int i = 0; i < 2; ++i) {
    int row = cell.y + i;
    int col = cell.x + i;
    ScarpNode r0 = scarp_node(field, cell.x - 1, row);
    ScarpNode r1 = scarp_node(field, cell.x, row);
    ScarpNode r2 = scarp_node(field, cell.x + 1, row);
    ScarpNode r3 = scarp_node(field, cell.x + 2, row);
    float weight = i == 0 ? 1.0f - place.y : place.y;
    sum.x += weight * ((1.0f - place.x) * scarp_node_slope(r0, r1, r2) + place.x * scarp_node_slope(r1, r2, r3));
    ScarpNode c0 = scarp_node(field, col, cell.y - 1);
    ScarpNode c1 = scarp_node(field, col, cell.y);
    ScarpNode c2 = scarp_node(field, col, cell.y + 1);
    ScarpNode c3 = scarp_node(field, col, cell.y + 2);
    weight = i == 0 ? 1.0f - place.x : place.x;
    sum.y += weight * ((1.0f - place.y) * scarp_node_slope(c0, c1, c2) + place.y * scarp_node_slope(c1, c2, c3));
  }
  return sum;
}

SCARP_GLSL_END

#endif
