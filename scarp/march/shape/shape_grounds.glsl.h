// SPDX-License-Identifier: MIT
// The ground of a height field as a solid in a shape, for shaders: field_ground_value() and over_hole() of the field
// station (distance_local.cpp, ground_holes.cpp) in floats.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0. The including file must define
//
//   float scarp_field_sample(int col, int row);      a sample of the field, in sample units; never a hole
//   bool scarp_field_hole(int col, int row);         whether a cell is a hole
#ifndef SCARP_MARCH_SHAPE_GROUNDS_GLSL_H
#define SCARP_MARCH_SHAPE_GROUNDS_GLSL_H

#include "scarp/march/shape/shape_distance.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Defined by the including file.
float scarp_field_sample(int col, int row);
bool scarp_field_hole(int col, int row);

/// Properties of the field besides its samples.
struct ScarpSolidField {
  ivec2 cells;    ///< columns and rows
  ivec2 samples;  ///< equal to `cells` if the last is followed by the first
  float cell_x;   ///< metres
  float cell_y;
  float metres_per_sample;
  float metres_at_zero;
  bool triangles;
  bool wraps;
  bool has_holes;
};

/// Along an axis: the cell that contains a position, in cells from the first line, and the position in it.
SCARP_FN void scarp_field_place(float place, int cells, bool wraps, SCARP_OUT(int) cell, SCARP_OUT(float) in_cell) {
  float at = place;
  float count = float(cells);
  if (wraps) at = at - floor(at / count) * count;
  at = clamp(at, 0.0f, count);
  cell = min(int(floor(at)), cells - 1);
  in_cell = at - float(cell);
}

/// Returns the distance to the rim of the nearest hole in metres, positive over holes, capped at the shorter side of a
/// cell.
SCARP_FN float scarp_field_rim(ScarpSolidField field, int col, int row, float u, float v) {
  bool hole = scarp_field_hole(col, row);
  float nearest = min(field.cell_x, field.cell_y);
  for (int i = 0; i < 9; ++i) {
    int dx = i % 3 - 1;
    int dy = i / 3 - 1;
    int c = col + dx;
    int r = row + dy;
    if (field.wraps) {
      c = c < 0 ? c + field.cells.x : c < field.cells.x ? c : c - field.cells.x;
      r = r < 0 ? r + field.cells.y : r < field.cells.y ? r : r - field.cells.y;
    }
    if (c < 0 || r < 0 || c >= field.cells.x || r >= field.cells.y) continue;
    if (scarp_field_hole(c, r) == hole) continue;
    float x = (dx < 0 ? u : dx > 0 ? 1.0f - u : 0.0f) * field.cell_x;
    float y = (dy < 0 ? v : dy > 0 ? 1.0f - v : 0.0f) * field.cell_y;
    nearest = min(nearest, scarp_length2(x, y));
  }
  return hole ? nearest : -nearest;
}

/// Returns the value at q, in the field's own frame: the height above the ground times `shrink`, with walls and holes.
SCARP_FN float scarp_field_ground(ScarpSolidField field, vec3 q, float shrink) {
  int col;
  int row;
  float u;
  float v;
  // Rows run southwards.
  float last_row = float(field.samples.y - 1);
  scarp_field_place(q.x / field.cell_x, field.cells.x, field.wraps, col, u);
  scarp_field_place(last_row - q.y / field.cell_y, field.cells.y, field.wraps, row, v);
  int east = col + 1 < field.samples.x ? col + 1 : 0;
  int south = row + 1 < field.samples.y ? row + 1 : 0;
  float h00 = scarp_field_sample(col, row);
  float h10 = scarp_field_sample(east, row);
  float h01 = scarp_field_sample(col, south);
  float h11 = scarp_field_sample(east, south);
  float height;
  if (!field.triangles) {
    float north_height = h00 + u * (h10 - h00);
    height = north_height + v * ((h01 + u * (h11 - h01)) - north_height);
  } else if (u + v <= 1.0f) {
    height = h00 + u * (h10 - h00) + v * (h01 - h00);
  } else {
    height = h11 + (1.0f - u) * (h01 - h11) + (1.0f - v) * (h10 - h11);
  }
  float value = (q.z - (height * field.metres_per_sample + field.metres_at_zero)) * shrink;
  if (!field.wraps) {
    float width = float(field.cells.x) * field.cell_x;
    float depth = float(field.cells.y) * field.cell_y;
    value = max(value, scarp_corner2(max(-q.x, q.x - width), max(-q.y, q.y - depth)));
  }
  return field.has_holes ? max(value, scarp_field_rim(field, col, row, u, v)) : value;
}

SCARP_GLSL_END

#endif
