// SPDX-License-Identifier: MIT
// Clearance (ray height - surface height) of a ray in one cell, in single precision: cell_surface.h for shaders.
// Heights are relative to the frame's base, so that floats resolve the relief around the ray.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0. The including file must define
//   float scarp_sample(int col, int row)       the sample at a node of the grid
//   bool scarp_is_nodata(float value)         whether the value marks a hole; not called without kScarpHoles
#ifndef SCARP_MARCH_CELL_SURFACE_GLSL_H
#define SCARP_MARCH_CELL_SURFACE_GLSL_H

#include "scarp/march/height/ray_frame.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Corner heights of a cell, relative to a base: h10 is at (col+1, row), h01 at (col, row+1).
struct ScarpCell {
  float h00, h10, h01, h11;
  bool hole;  ///< a corner is nodata, and the heights are undefined
};

/// Four samples, minus `base`.
SCARP_FN ScarpCell scarp_cell(ScarpField field, int col, int row, float base) {
  int next_col = col + 1 < field.samples.x ? col + 1 : 0;
  int next_row = row + 1 < field.samples.y ? row + 1 : 0;
  float s00 = scarp_sample(col, row);
  float s10 = scarp_sample(next_col, row);
  float s01 = scarp_sample(col, next_row);
  float s11 = scarp_sample(next_col, next_row);
  ScarpCell cell;
  cell.hole = (field.flags & kScarpHoles) != 0u &&
              (scarp_is_nodata(s00) || scarp_is_nodata(s10) || scarp_is_nodata(s01) || scarp_is_nodata(s11));
  cell.h00 = s00 - base;
  cell.h10 = s10 - base;
  cell.h01 = s01 - base;
  cell.h11 = s11 - base;
  return cell;
}

/// Lowest corner of a cell that is not a hole.
SCARP_FN float scarp_lowest(ScarpCell cell) { return min(min(cell.h00, cell.h10), min(cell.h01, cell.h11)); }
/// Highest corner of a cell that is not a hole.
SCARP_FN float scarp_highest(ScarpCell cell) { return max(max(cell.h00, cell.h10), max(cell.h01, cell.h11)); }

/// Height of the bilinear surface at a position in the cell.
SCARP_FN float scarp_bilinear(ScarpCell cell, float u, float v) {
  SCARP_PRECISE float height = cell.h00 + ((cell.h10 - cell.h00) * u + (cell.h01 - cell.h00) * v +
                                           ((cell.h11 - cell.h01) - (cell.h10 - cell.h00)) * (u * v));
  return height;
}
/// Height of one of its two triangles: that with (col+1, row+1), or that with (col, row).
SCARP_FN float scarp_triangle(ScarpCell cell, bool south_east, float u, float v) {
  SCARP_PRECISE float north_west_height = cell.h00 + ((cell.h10 - cell.h00) * u + (cell.h01 - cell.h00) * v);
  SCARP_PRECISE float south_east_height =
      cell.h11 - ((cell.h11 - cell.h01) * (1.0f - u) + (cell.h11 - cell.h10) * (1.0f - v));
  return south_east ? south_east_height : north_west_height;
}
/// Height of the field's surface: bilinear, or the triangle at the position.
SCARP_FN float scarp_surface(ScarpField field, ScarpCell cell, float u, float v) {
  return (field.flags & kScarpTriangles) != 0u ? scarp_triangle(cell, u + v > 1.0f, u, v) : scarp_bilinear(cell, u, v);
}

/// Height of a crossing between two nodes. Rounding must not move it beyond either: the pyramid bounds the nodes.
SCARP_FN float scarp_edge_height(float a, float b, float place) {
  SCARP_PRECISE float height = a + place * (b - a);
  return clamp(height, min(a, b), max(a, b));
}

// How a ray enters or leaves a cell: not through a line, through one of constant column, or of constant row.
const int kScarpPoint = 0;
const int kScarpLineX = 1;
const int kScarpLineY = 2;

/// Clearance of the ray at local time t, where it enters or leaves the cell. At a line, computed from the two nodes of
/// that side alone.
SCARP_FN float scarp_clearance(ScarpField field, ScarpFrame frame, ScarpRay ray, ScarpCell cell, int col, int row,
                               int through, bool leaving, float t) {
  float u = scarp_place_x(frame, ray, t, col);
  float v = scarp_place_y(frame, ray, t, row);
  float ground;
  if (through == kScarpLineX) {
    bool east = (ray.direction.x >= 0.0f) == leaving;
    ground = scarp_edge_height(east ? cell.h10 : cell.h00, east ? cell.h11 : cell.h01, v);
  } else if (through == kScarpLineY) {
    bool south = (ray.direction.y >= 0.0f) == leaving;
    ground = scarp_edge_height(south ? cell.h01 : cell.h00, south ? cell.h11 : cell.h10, u);
  } else {
    ground = scarp_surface(field, cell, u, v);
  }
  SCARP_PRECISE float above = scarp_ray_height(frame, ray, t) - ground;
  return above;
}

/// Clearance in one bilinear cell: f(s) = (a s + b) s + c, s from local time t on.
struct ScarpQuadratic {
  float a, b, c;
};

/// Returns the clearance of a ray over a cell, with s counting from local time t.
SCARP_FN ScarpQuadratic scarp_quadratic(ScarpFrame frame, ScarpRay ray, ScarpCell cell, int col, int row, float t) {
  float u = scarp_place_x(frame, ray, t, col);
  float v = scarp_place_y(frame, ray, t, row);
  float hu = cell.h10 - cell.h00;
  float hv = cell.h01 - cell.h00;
  float twist = (cell.h11 - cell.h01) - hu;
  ScarpQuadratic f;
  f.a = -twist * ray.direction.x * ray.direction.y;
  f.b = ray.direction.z -
        (hu * ray.direction.x + hv * ray.direction.y + twist * (u * ray.direction.y + v * ray.direction.x));
  f.c = scarp_ray_height(frame, ray, t) - scarp_bilinear(cell, u, v);
  return f;
}

/// The root where f falls, without cancellation, as in Ramsey et al. 2004; may be at infinity.
SCARP_FN float scarp_falling_root(ScarpQuadratic f) {
  float root = sqrt(max(0.0f, f.b * f.b - 4.0f * f.a * f.c));
  return f.b < 0.0f ? 2.0f * f.c / (root - f.b) : (f.a < 0.0f ? -(f.b + root) / (2.0f * f.a) : kScarpNever);
}
/// Returns whether f, positive at 0 and `length`, reaches `level` <= 0 in between.
SCARP_FN bool scarp_dips(ScarpQuadratic f, float length, float level) {
  return f.a > 0.0f && f.b < 0.0f && -f.b < 2.0f * f.a * length && f.b * f.b >= 4.0f * f.a * (f.c - level);
}
/// Returns whether f has its maximum in between, above `level`.
SCARP_FN bool scarp_peaks(ScarpQuadratic f, float length, float level) {
  return f.a < 0.0f && f.b > 0.0f && f.b < -2.0f * f.a * length && f.c - f.b * f.b / (4.0f * f.a) > level;
}

SCARP_GLSL_END

#endif
