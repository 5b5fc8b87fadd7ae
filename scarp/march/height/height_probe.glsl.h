// SPDX-License-Identifier: MIT
// The probe of height fields, in single precision: the height of a ray's point above the ground, and the distance to
// the nearest hole.
//
// A point at time s is computed from the ray's own numbers in twice float precision: only s is rounded from one point
// to the next.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0. The including file must define what cell_surface.glsl.h requires,
// and scarp_minimum of max_mip.glsl.h.
#ifndef SCARP_MARCH_HEIGHT_PROBE_GLSL_H
#define SCARP_MARCH_HEIGHT_PROBE_GLSL_H

#include "scarp/march/height/cell_surface.glsl.h"
#include "scarp/march/height/ray_frame.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// A point of a ray.
struct ScarpPoint {
  bool valid;       ///< false over holes
  float clearance;  ///< vertical distance above the ground, in sample units
  ivec2 cell;
  vec2 place;  ///< in it, 0..1
};

/// Cells from the start of one copy of the field, 0 to `cells` inclusive; and the position in the cell.
SCARP_FN void scarp_over_field(ScarpTwoFloat way, int cell, int cells, bool wraps, SCARP_OUT(int) found,
                               SCARP_OUT(float) place) {
  float whole = floor(way.high);
  SCARP_PRECISE float rest = (way.high - whole) + way.low;
  float carry = floor(rest);
  found = cell + int(whole) + int(carry);
  place = clamp(rest - carry, 0.0f, 1.0f);
  if (wraps) {
    found -= int(floor(float(found) / float(cells))) * cells;
    // The quotient is rounded.
    if (found < 0) found += cells;
    if (found >= cells) found -= cells;
  } else if (found < 0) {
    found = 0;
    place = 0.0f;
  } else if (found >= cells) {
    found = cells - 1;
    place = 1.0f;
  }
}

/// The ray's point at time s. The clearance has an error of 16 units of the relief of its cell and of the ray's height
/// above the cell.
SCARP_FN ScarpPoint scarp_point(ScarpField field, ScarpRay ray, float s) {
  bool wraps = (field.flags & kScarpWraps) != 0u;
  ScarpTwoFloat x = scarp_two_line(0.0f, ray.place.x, ray.place_low.x, ray.direction.x, ray.direction_low.x, s);
  ScarpTwoFloat y = scarp_two_line(0.0f, ray.place.y, ray.place_low.y, ray.direction.y, ray.direction_low.y, s);
  ScarpTwoFloat z = scarp_two_line(0.0f, ray.z, ray.z_low, ray.direction.z, ray.direction_low.z, s);
  ScarpPoint point;
  int col;
  int row;
  float u;
  float v;
  scarp_over_field(x, ray.cell.x, field.cells.x, wraps, col, u);
  scarp_over_field(y, ray.cell.y, field.cells.y, wraps, row, v);
  point.cell = ivec2(col, row);
  point.place = vec2(u, v);
  ScarpCell cell = scarp_cell(field, col, row, z.high);
  point.valid = !cell.hole;
  point.clearance = cell.hole ? 0.0f : z.low - scarp_surface(field, cell, u, v);
  return point;
}

/// Time until the ray leaves cells [begin, end) of an axis, from a position in cell `cell`; positions have rounding
/// errors of half a unit.
SCARP_FN float scarp_time_to_border(int begin, int end, int cell, float place, float direction, float per_direction) {
  if (direction == 0.0f) return kScarpNever;
  return (float((direction > 0.0f ? end : begin) - cell) - place) * per_direction + kScarpUnit * abs(per_direction);
}

/// Time at which the ray, over a point at s, leaves the block of 2^level x 2^level cells that contains it: later by a
/// margin of 2^-20 of a cell plus the rounding of times, which is 3 units of the distance ahead, 2.5 more where the
/// device divides, and 2 of the sum.
SCARP_FN float scarp_leave_time(ScarpField field, ScarpRay ray, ScarpPoint point, int level, float s) {
  int col = (point.cell.x >> level) << level;
  int row = (point.cell.y >> level) << level;
  float x = scarp_time_to_border(col, min(col + (1 << level), field.cells.x), point.cell.x, point.place.x,
                                 ray.direction.x, ray.per_direction.x);
  float y = scarp_time_to_border(row, min(row + (1 << level), field.cells.y), point.cell.y, point.place.y,
                                 ray.direction.y, ray.per_direction.y);
  float ahead = max(0.0f, min(x, y));
  return s + (ahead + 9.5367431640625e-7f * ray.cell_time + 8.0f * kScarpUnit * (s + ahead));
}

/// The time until which the field's slope bound holds from a point: to the edge of the largest block around it without
/// holes; over a hole, to the edge of its cell.
SCARP_FN float scarp_bounded_until(ScarpField field, ScarpRay ray, ScarpPoint point, float s,
                                   SCARP_INOUT(uint) fetches) {
  int level = 0;
  while (point.valid && level < field.top_level) {
    fetches += 1u;
    if (scarp_minimum(level + 1, point.cell.x >> (level + 1), point.cell.y >> (level + 1)) == 0.0f) break;
    ++level;
  }
  return scarp_leave_time(field, ray, point, level, s);
}

SCARP_GLSL_END

#endif
