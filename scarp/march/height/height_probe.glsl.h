// SPDX-License-Identifier: MIT
// What the marches that take samples along the ray (naive, fixed-step, relaxed, lipschitz) need of a height field, in
// single precision: how far above the ground a point of the ray is.
//
// A point at time s is computed from the ray's own numbers in twice a float's precision: s is the only thing that is
// rounded on the way from one point to the next.
//
// Text of C++ and of GLSL, GLSL ES 3.0 included; who includes it has defined what cell_surface.glsl.h asks for.
#ifndef SCARP_MARCH_HEIGHT_PROBE_GLSL_H
#define SCARP_MARCH_HEIGHT_PROBE_GLSL_H

#include "scarp/march/height/cell_surface.glsl.h"
#include "scarp/march/height/ray_frame.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// A point of a ray.
struct ScarpPoint {
  bool valid;       ///< false over holes
  float clearance;  ///< sample units that the ray is above the ground, vertically
  ivec2 cell;
  vec2 place;  ///< in it, 0..1
};

/// Cells from the begin of one copy of the field, 0 up to `cells`, last one included; and the place in the cell.
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

/// The ray's point at time s. Clearance has an error of 16 units of the relief of its cell and of what the ray is above
/// it.
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

/// A hit at a point.
SCARP_FN void scarp_tell_point(ScarpPoint point, float s, int status, SCARP_INOUT(ScarpHit) hit) {
  hit.status = status;
  hit.cell = point.cell;
  hit.place = point.place;
  hit.time = s;
  hit.time_low = 0.0f;
}

/// Used up a limit of steps at time s.
SCARP_FN void scarp_give_up(float s, SCARP_INOUT(ScarpHit) hit) {
  hit.status = kScarpExhausted;
  hit.time = s;
  hit.time_low = 0.0f;
}

SCARP_GLSL_END

#endif
