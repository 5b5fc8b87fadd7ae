// SPDX-License-Identifier: MIT
// A ray over a height field in single precision: the field and the ray in the form that shaders use, and the frame of
// reference in which floats are exact enough.
//
//   +-----------+-----------+     A frame is a tile of the grid, at most 1,024 cells wide. The ray restarts in it: at
//   |           | o---      |     time s0 it is at o, and times, columns, rows and heights count from there. o is
//   |        __-+-          |     computed from the ray's own numbers in twice a float's precision, never from the
//   |    _--    |           |     previous frame, so nothing accumulates. s0 has no error: it is a float, whatever it
//   +-----------+-----------+     was computed from.
//
// Units: x in columns, y in rows (southwards), z in sample units. Time s counts from the ray's start, in lengths of its
// direction, whose longer horizontal component is 1 to 2 cells. Derivation of the rounding errors: doc/dev/numerics.md.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0.
#ifndef SCARP_MARCH_RAY_FRAME_GLSL_H
#define SCARP_MARCH_RAY_FRAME_GLSL_H

#include "scarp/march/march_state.glsl.h"
#include "scarp/march/two_float.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

const uint kScarpTriangles = 1u;  ///< two triangles per cell instead of a bilinear patch
const uint kScarpHoles = 2u;      ///< some samples are nodata
const uint kScarpWraps = 4u;      ///< the field wraps
const uint kScarpSolid = 8u;      ///< the ground is solid
const uint kScarpStarts = 16u;    ///< some rays may start on the surface (max_mip_lean.glsl.h)

/// Properties of a height field, besides its samples and bounds, that a march needs. All in sample units.
struct ScarpField {
  ivec2 cells;          ///< columns and rows of cells, at least 1
  ivec2 samples;        ///< columns and rows of samples; equal to `cells` if the last is followed by the first
  int top_level;        ///< of the pyramid, at least 1; 0: no pyramid
  uint flags;           ///< kScarpTriangles and so on
  float code_base;      ///< height of a pyramid entry: code_base + code_base_low + code_step * code
  float code_base_low;  ///< remainder of the base
  float code_step;      ///< height of one code
  float lowest;         ///< sample
  float highest;        ///< sample
};

const uint kScarpOnSurface = 1u;      ///< starts on the surface of its cell: above it by definition, z is not read
const uint kScarpFromOutside = 2u;    ///< enters through the border
const uint kScarpAbove = 4u;          ///< starts no lower than the highest sample
const uint kScarpUpright = 8u;        ///< straight up or down: direction.x and .y are 0
const uint kScarpThroughWalls = 16u;  ///< ignores walls of solid ground; read by batches (ray_batch.glsl.h)

/// A ray that starts over the field. Callers with doubles pass all numbers as two floats (march/height/device_ray.h);
/// the low parts may be zero.
struct ScarpRay {
  ivec2 cell;          ///< over which it starts
  vec2 place;          ///< position in it, 0..1, both ends included
  vec2 place_low;      ///< remainder in float, here and below
  vec3 direction;      ///< the larger of abs x, abs y is 1 to 2, unless it is upright: then abs z is
  vec3 direction_low;  ///< likewise
  vec2 per_direction;  ///< 1 / direction; kScarpNever where the direction is 0
  float z;             ///< at its start
  float z_low;         ///< likewise
  float end;           ///< the last time, included; at most kScarpNever
  float end_low;       ///< likewise
  uint flags;          ///< kScarpOnSurface and so on
  // For the sampling marches (height_probe.glsl.h).
  float travelled;   ///< time from the start of the ray's range to this ray's start
  float exit;        ///< when it leaves the field or its range ends; `end` may be earlier
  float per_height;  ///< time in which the ray travels the height of one sample unit
  float cell_time;   ///< time in which it travels the shorter side of a cell
};

/// The result. Cell, place and time are defined for hits (time also for exhausted).
struct ScarpHit {
  int status;      ///< kScarpMiss and so on
  ivec2 cell;      ///< column and row, counted from the field's first
  vec2 place;      ///< in the cell, 0..1
  float time;      ///< time + time_low is the ray's time there
  float time_low;  ///< since the tile's start, so it may be as large as `time`
  uint steps;      ///< blocks, cells or points visited
  uint fetches;    ///< samples and entries of the pyramid read
};

/// More loop iterations than any march takes; half of the integer range, so that counting past it does not overflow.
const int kScarpAllTurns = 1073741824;
/// Unit roundoff of a float, 2^-24.
const float kScarpUnit = 5.9604644775390625e-8f;
/// Tiles are 2^kScarpTileLevel cells wide, and no visited block is wider.
const int kScarpTileLevel = 10;
/// Cells up to which a ray is followed over a wrapped field: floats represent integers up to 2^24.
const int kScarpFarthestCell = 8388608;

/// The ray in a tile.
struct ScarpFrame {
  ivec2 begin;  ///< the tile's first column and row
  ivec2 end;    ///< its last ones + 1
  ivec2 lap;    ///< the first column and row of this copy of the field; 0 unless it wraps
  vec2 o;       ///< position of the ray at local time 0, relative to `begin`
  vec2 o_low;
  float s0;     ///< the ray's time at local time 0
  float base;   ///< heights count from it
  float z;      ///< the ray's height at local time 0, relative to `base`
  float t_end;  ///< the ray's end, in local time
};

/// A miss without cost: the initial state of marches.
SCARP_FN ScarpHit scarp_no_hit() {
  ScarpHit hit;
  hit.status = kScarpMiss;
  hit.cell = ivec2(0, 0);
  hit.place = vec2(0.0f, 0.0f);
  hit.time = kScarpNever;
  hit.time_low = 0.0f;
  hit.steps = 0u;
  hit.fetches = 0u;
  return hit;
}

/// The frame of the tile that contains `cell` of the copy of the field that starts at `lap`; local time 0 is the ray's
/// time s0. Error of o: 2^-45 of the cells from the ray's start.
SCARP_FN ScarpFrame scarp_frame(ScarpField field, ScarpRay ray, ivec2 cell, ivec2 lap, float s0) {
  ScarpFrame frame;
  frame.begin = ivec2((cell.x >> kScarpTileLevel) << kScarpTileLevel, (cell.y >> kScarpTileLevel) << kScarpTileLevel);
  frame.end = ivec2(min(frame.begin.x + (1 << kScarpTileLevel), field.cells.x),
                    min(frame.begin.y + (1 << kScarpTileLevel), field.cells.y));
  frame.lap = lap;
  frame.s0 = s0;
  ScarpTwoFloat x = scarp_two_line(float(ray.cell.x - lap.x - frame.begin.x), ray.place.x, ray.place_low.x,
                                   ray.direction.x, ray.direction_low.x, s0);
  ScarpTwoFloat y = scarp_two_line(float(ray.cell.y - lap.y - frame.begin.y), ray.place.y, ray.place_low.y,
                                   ray.direction.y, ray.direction_low.y, s0);
  ScarpTwoFloat z = scarp_two_line(0.0f, ray.z, ray.z_low, ray.direction.z, ray.direction_low.z, s0);
  frame.o = vec2(x.high, y.high);
  frame.o_low = vec2(x.low, y.low);
  frame.base = z.high;
  frame.z = z.low;
  SCARP_PRECISE float end = (ray.end - s0) + ray.end_low;
  frame.t_end = end;
  return frame;
}

/// Local time at which the ray crosses line k of the columns, by ONE expression for all callers. Each operation rounds
/// monotonically, so lines are crossed in order.
SCARP_FN float scarp_line_x(ScarpFrame frame, ScarpRay ray, int k) {
  // A ray along a line belongs to the cell that it starts in.
  if (ray.direction.x == 0.0f) return k + frame.lap.x > ray.cell.x ? kScarpNever : -kScarpNever;
  SCARP_PRECISE float t = ((float(k - frame.begin.x) - frame.o.x) - frame.o_low.x) * ray.per_direction.x;
  return t;
}
/// The same for line k of the rows.
SCARP_FN float scarp_line_y(ScarpFrame frame, ScarpRay ray, int k) {
  if (ray.direction.y == 0.0f) return k + frame.lap.y > ray.cell.y ? kScarpNever : -kScarpNever;
  SCARP_PRECISE float t = ((float(k - frame.begin.y) - frame.o.y) - frame.o_low.y) * ray.per_direction.y;
  return t;
}

/// Position in a column of cells at local time t, 0..1.
SCARP_FN float scarp_place_x(ScarpFrame frame, ScarpRay ray, float t, int col) {
  SCARP_PRECISE float u = ((frame.o.x - float(col - frame.begin.x)) + frame.o_low.x) + ray.direction.x * t;
  return clamp(u, 0.0f, 1.0f);
}
/// The same in a row of cells.
SCARP_FN float scarp_place_y(ScarpFrame frame, ScarpRay ray, float t, int row) {
  SCARP_PRECISE float v = ((frame.o.y - float(row - frame.begin.y)) + frame.o_low.y) + ray.direction.y * t;
  return clamp(v, 0.0f, 1.0f);
}

/// The ray's height at local time t, relative to the frame's base.
SCARP_FN float scarp_ray_height(ScarpFrame frame, ScarpRay ray, float t) {
  SCARP_PRECISE float z = frame.z + ray.direction.z * t;
  return z;
}

/// Maximum rounding error of ray height - surface height at local time t, in sample units, for surface heights up to
/// `height` relative to the base that differ by `relief` between corners of a cell: 16 units of the operands, of which
/// numerics.md counts 12.
SCARP_FN float scarp_rounding(ScarpFrame frame, ScarpRay ray, float t, float height, float relief) {
  float sideways = abs(ray.direction.x * t) + abs(ray.direction.y * t) + 1.0f;
  return 16.0f * kScarpUnit * (abs(frame.z) + abs(ray.direction.z * t) + height + sideways * relief);
}

SCARP_GLSL_END

#endif
