// SPDX-License-Identifier: MIT
// The first pass of `max-mip` on devices: the traversal of max_mip.h in plain floats, with a margin for their error.
//
//   frame: the ray restarts at time s0, mirrored so that it goes towards +x and +y
//     walk, a block per turn:  one load: the maxima of its 2 x 2 children (GroundQuads)
//       the ray is above every child on its path by more than the margin   leave the block, go up a level
//       else                                                              on to the first child that it may meet
//     in a cell:  above by more than the margin                           leave the cell
//                 else, more than a few cells from the frame's start      a new frame that begins here
//                 else                                                    the sign of the clearance decides
//
// A frame starts at a point that two floats represent exactly, and in its first cells floats are exact to 2^-18 of a
// cell. A hit is decided and located there, for any length of the ray, and the margin only costs a new frame for rays
// that graze the ground. A ray that starts below the surface, or enters it from a hole, is left to the exact
// implementation (max_mip.glsl.h) in a second pass: the status is then kScarpDoubtful.
//
// Guarantee: decisions are those for a surface and a ray displaced by at most the bound that doc/dev/numerics.md
// derives ("The lean pass"); closest and any hit agree. For fields of fewer than 2^17 cells a side whose heights differ
// by less than 2^100. Source: see max_mip.h.
//
// Compiles as C++ and GLSL. The including file defines scarp_sample and scarp_is_nodata (cell_surface.glsl.h), and
//   vec4 scarp_corners(int col, int row)            the samples at (col, row), (col + 1, row), (col, row + 1) and
//                                                   (col + 1, row + 1), of fields that do not wrap
//   uvec2 scarp_quad(int level, int col, int row)   codes of the 2 x 2 children of a block, level 1 and up:
//                                                   .x: (0, 0) | (1, 0) << 16, .y: (0, 1) | (1, 1) << 16
#ifndef SCARP_MARCH_MAX_MIP_LEAN_GLSL_H
#define SCARP_MARCH_MAX_MIP_LEAN_GLSL_H

#include "scarp/march/height/cell_surface.glsl.h"
#include "scarp/march/height/lean_place.glsl.h"
#include "scarp/march/height/ray_frame.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Local time up to which signs decide. The ray crosses at most twice as many cells in it.
const float kScarpFreshTime = 4.0f;
/// Blocks and cells after which a ray is left to the second pass, which can be interrupted.
const int kScarpLeanTurns = 16384;
/// Maximum error of a block's height in floats, in codes (numerics.md counts 0.27).
const float kScarpCodeRounding = 0.5f;

/// The status of a ray that continues in a new frame.
const int kScarpFrame = -2;

/// State of a ray between two frames.
struct ScarpLean {
  float s0;      ///< time at which the next frame starts; 0: it is the ray's first
  int above;     ///< over fields that wrap, 1: the ray is known to be above the surface at s0
  int turns;     ///< blocks so far
  uint fetches;  ///< so far
};

/// The state before the first frame.
SCARP_FN ScarpLean scarp_lean_begin() {
  ScarpLean at;
  at.s0 = 0.0f;
  at.above = 0;
  at.turns = 0;
  at.fetches = 0u;
  return at;
}

/// The ray in a frame. Mirrored cell numbers are those of the grid or, along axes on which the ray runs backwards,
/// their complements, so that it always runs forwards and blocks are the same.
struct ScarpLeanFrame {
  int mirror_x, mirror_y;  ///< 0, or -1 if the ray runs backwards
  int begin_x, begin_y;    ///< the cell in which the frame starts, mirrored
  float ox, oy;            ///< position in it, 0..1 in the ray's direction
  float dx, dy;            ///< not negative
  int last_x, last_y;      ///< the last cell of the grid ahead, mirrored
  int col, row;            ///< the first cell in the grid's numbers
  float place_x, place_y;  ///< position in it, 0..1 in the grid's direction
  float per_x, per_y;      ///< 1 / dx, 1 / dy; kScarpNever for 0
  float base;              ///< heights count from it
  float z, dz;             ///< of the ray, from the base
  float end;               ///< of the ray, local time
  float start_relief;      ///< height difference in the start cell of a ray from the surface
};

/// Returns the frame that starts at time s0.
SCARP_FN ScarpLeanFrame scarp_lean_frame(ScarpField field, ScarpRay ray, float s0, bool strict) {
  bool wraps = (field.flags & kScarpWraps) != 0u;
  ScarpLeanFrame frame;
  float z = ray.z;
  float z_low = ray.z_low;
  frame.start_relief = 0.0f;
  if (strict) {
    ScarpCell cell = scarp_cell(field, ray.cell.x, ray.cell.y, 0.0f);
    ScarpCell above_node = scarp_cell(field, ray.cell.x, ray.cell.y, cell.h00);
    frame.start_relief = scarp_highest(above_node) - scarp_lowest(above_node);
    z = cell.h00;
    z_low = scarp_surface(field, above_node, ray.place.x, ray.place.y);
  }
  ScarpLeanAxis x = scarp_lean_axis(ray.cell.x, ray.place.x, ray.place_low.x, ray.direction.x, ray.direction_low.x, s0,
                                    field.cells.x, wraps);
  ScarpLeanAxis y = scarp_lean_axis(ray.cell.y, ray.place.y, ray.place_low.y, ray.direction.y, ray.direction_low.y, s0,
                                    field.cells.y, wraps);
  ScarpTwoFloat height = scarp_lean_height(z, z_low, ray.direction.z, ray.direction_low.z, s0, wraps);
  frame.base = height.high;
  frame.z = height.low;
  frame.dz = ray.direction.z;
  frame.mirror_x = ray.direction.x < 0.0f ? -1 : 0;
  frame.mirror_y = ray.direction.y < 0.0f ? -1 : 0;
  frame.last_x = frame.mirror_x == 0 ? field.cells.x - 1 : -1;
  frame.last_y = frame.mirror_y == 0 ? field.cells.y - 1 : -1;
  frame.begin_x = x.cell ^ frame.mirror_x;
  frame.begin_y = y.cell ^ frame.mirror_y;
  frame.col = x.cell;
  frame.row = y.cell;
  frame.place_x = x.place;
  frame.place_y = y.place;
  frame.ox = frame.mirror_x == 0 ? x.place : 1.0f - x.place;
  frame.oy = frame.mirror_y == 0 ? y.place : 1.0f - y.place;
  frame.dx = abs(ray.direction.x);
  frame.dy = abs(ray.direction.y);
  frame.per_x = abs(ray.per_direction.x);
  frame.per_y = abs(ray.per_direction.y);
  SCARP_PRECISE float end = (ray.end - s0) + ray.end_low;
  frame.end = end;
  return frame;
}

/// Time at which the ray crosses a line, by ONE expression for all blocks; `cells` counts from the frame's first cell,
/// `origin` is place * per.
SCARP_FN float scarp_lean_line(float cells, float per, float origin) { return fma(cells, per, -origin); }

/// The clearance of a ray over a piece of a cell: above + (chord - bend) s + bend s^2, s from 0 to 1.
struct ScarpPiece {
  float begin, end;  ///< local times
  float above;
  float chord;
  float bend;
};

/// The s at which the clearance of a piece falls to 0. A free ray that starts at 0 hits there; one that starts on the
/// surface hits where it comes down again.
SCARP_FN float scarp_fall_of(ScarpPiece piece, bool strict) {
  float slope = piece.chord - piece.bend;
  float root = sqrt(max(0.0f, slope * slope - 4.0f * piece.bend * piece.above));
  bool falls = slope < 0.0f;
  float sum = -0.5f * (slope + (falls ? -root : root));
  float s = (falls ? piece.above : sum) / (falls ? sum : piece.bend);
  return piece.above > 0.0f || strict ? clamp(s, 0.0f, 1.0f) : 0.0f;
}

/// A cell under the ray.
struct ScarpLeanCell {
  bool hole;
  float above;       ///< clearance where the ray enters it
  float least;       ///< the lowest clearance
  float margin;      ///< error of both
  float limit;       ///< lower than this: a hit
  ScarpPiece piece;  ///< in which the clearance falls
};

/// The cell (col, row) of the grid, from time `begin` to `end`; `spread` is ScarpLeanCodes::spread.
SCARP_FN ScarpLeanCell scarp_lean_cell(ScarpField field, float spread, ScarpLeanFrame frame, vec3 direction, int col,
                                       int row, float begin, float end, bool strict) {
  bool triangles = (field.flags & kScarpTriangles) != 0u;
  bool wraps = (field.flags & kScarpWraps) != 0u;
  vec2 north;
  vec2 south;
  if (wraps) {
    int next_col = col + 1 < field.samples.x ? col + 1 : 0;
    int next_row = row + 1 < field.samples.y ? row + 1 : 0;
    north = vec2(scarp_sample(col, row), scarp_sample(next_col, row));
    south = vec2(scarp_sample(col, next_row), scarp_sample(next_col, next_row));
  } else {
    vec4 corners = scarp_corners(col, row);
    north = vec2(corners.x, corners.y);
    south = vec2(corners.z, corners.w);
  }
  ScarpLeanCell found;
  found.hole = (field.flags & kScarpHoles) != 0u && (scarp_is_nodata(north.x) || scarp_is_nodata(north.y) ||
                                                     scarp_is_nodata(south.x) || scarp_is_nodata(south.y));
  ScarpCell h;
  h.hole = found.hole;
  h.h00 = north.x - frame.base;
  h.h10 = north.y - frame.base;
  h.h01 = south.x - frame.base;
  h.h11 = south.y - frame.base;
  float z0 = frame.z + frame.dz * begin;
  float z1 = frame.z + frame.dz * end;
  float size = abs(frame.z) + abs(frame.dz * end) + max(max(abs(h.h00), abs(h.h10)), max(abs(h.h01), abs(h.h11)));
  found.margin = 16.0f * kScarpUnit * (size + frame.start_relief) + (spread + spread * end);
  bool fresh = begin <= kScarpFreshTime;
  found.limit = fresh ? 0.0f : found.margin;
  if (fresh && strict) {
    // Strictly below, by more than rounding: that of this cell, and of the start's.
    float relief = max(scarp_highest(h) - scarp_lowest(h), frame.start_relief);
    found.limit = -16.0f * kScarpUnit * (size + (1.0f + 2.0f * end) * relief);
  }
  float ux = frame.place_x - float(col - frame.col);
  float uy = frame.place_y - float(row - frame.row);
  float u0 = clamp(ux + direction.x * begin, 0.0f, 1.0f);
  float v0 = clamp(uy + direction.y * begin, 0.0f, 1.0f);
  float u1 = clamp(ux + direction.x * end, 0.0f, 1.0f);
  float v1 = clamp(uy + direction.y * end, 0.0f, 1.0f);
  found.piece.begin = begin;
  found.piece.end = end;
  if (triangles) {
    float beyond0 = (u0 + v0) - 1.0f;
    float beyond1 = (u1 + v1) - 1.0f;
    found.above = z0 - scarp_triangle(h, beyond0 > 0.0f, u0, v0);
    float end_above = z1 - scarp_triangle(h, beyond1 > 0.0f, u1, v1);
    found.least = min(found.above, end_above);
    found.piece.above = found.above;
    if ((beyond0 < 0.0f && beyond1 > 0.0f) || (beyond0 > 0.0f && beyond1 < 0.0f)) {
      float share = beyond0 / (beyond0 - beyond1);
      float above_diagonal = z0 + share * (z1 - z0) - (h.h10 + (v0 + share * (v1 - v0)) * (h.h01 - h.h10));
      float t_diagonal = begin + share * (end - begin);
      // Linear on either side: the fall is before the diagonal if the ray is below there.
      if (min(found.above, above_diagonal) > found.limit) {
        found.piece.begin = t_diagonal;
        found.piece.above = above_diagonal;
      } else {
        found.piece.end = t_diagonal;
        end_above = above_diagonal;
      }
      found.least = min(found.least, above_diagonal);
    }
    found.piece.chord = end_above - found.piece.above;
    found.piece.bend = 0.0f;
    return found;
  }
  float along_x = h.h10 - h.h00;
  float along_y = h.h01 - h.h00;
  float twist = (h.h11 - h.h01) - along_x;
  found.above = z0 - (h.h00 + (u0 * along_x + v0 * (along_y + u0 * twist)));
  float end_above = z1 - (h.h00 + (u1 * along_x + v1 * (along_y + u1 * twist)));
  found.piece.above = found.above;
  found.piece.chord = end_above - found.above;
  found.piece.bend = twist * (u1 - u0) * (v0 - v1);
  // A parabola that opens upwards has its lowest point in between if it falls at one end and rises at the other.
  float down = found.piece.chord - found.piece.bend;
  float lowest = found.above - down * down / (4.0f * found.piece.bend);
  found.least = found.piece.bend > abs(found.piece.chord) ? lowest : min(found.above, end_above);
  return found;
}

/// Follows the ray through one frame. Returns true if `hit` is the answer; its status may be kScarpDoubtful. Otherwise
/// call again. With `any`, only the status is defined. `field.top_level` must be at least 1.
SCARP_FN bool scarp_lean_on(ScarpField field, ScarpLeanCodes codes, ScarpRay ray, bool any, SCARP_INOUT(ScarpLean) at,
                            SCARP_OUT(ScarpHit) hit) {
  SCARP_COUNT(frame);
  bool strict = (field.flags & kScarpStarts) != 0u && (ray.flags & kScarpOnSurface) != 0u;
  bool wraps = (field.flags & kScarpWraps) != 0u;
  bool triangles = (field.flags & kScarpTriangles) != 0u;
  vec3 direction = ray.direction;
  ScarpLeanFrame frame = scarp_lean_frame(field, ray, at.s0, strict);
  // Heights in codes, less the margin m(t) = rounding + spread (1 + t).
  float code_spread = codes.spread * codes.per_step;
  float code_z = ((frame.base - field.code_base) + (frame.z - field.code_base_low)) * codes.per_step -
                 (kScarpCodeRounding + code_spread);
  float code_dz = frame.dz * codes.per_step - code_spread;
  float origin_x = frame.ox * frame.per_x;
  float origin_y = frame.oy * frame.per_y;
  // Up to the border, the ray's end, and where it rises above all ground.
  float border_x = scarp_lean_line(float(frame.last_x + 1 - frame.begin_x), frame.per_x, origin_x);
  float border_y = scarp_lean_line(float(frame.last_y + 1 - frame.begin_y), frame.per_y, origin_y);
  float border = min(border_x, border_y);
  float end = frame.end;
  if (code_dz > 0.0f) end = min(end, (codes.over - code_z) / code_dz);
  float last = min(end, border);

  bool back_x = frame.mirror_x != 0;
  bool back_y = frame.mirror_y != 0;
  int status = kScarpMiss;
  int x = frame.begin_x;
  int y = frame.begin_y;
  bool from_afar = (ray.flags & (kScarpAbove | kScarpFromOutside)) != 0u && at.s0 == 0.0f;
  int level = from_afar ? max(field.top_level - 3, 1) : 1;
  float t = 0.0f;
  // A frame in which the ray is not known to be above ends only at the border of a copy.
  bool above = at.s0 > 0.0f ? !wraps || at.above != 0 : (ray.flags & (kScarpAbove | kScarpOnSurface)) != 0u;
  int turn = at.turns;
  int hit_col = 0;
  int hit_row = 0;
  ScarpPiece piece;
  piece.begin = 0.0f;
  piece.end = 0.0f;
  piece.above = 0.0f;
  piece.chord = 0.0f;
  piece.bend = 0.0f;
  do {
    SCARP_COUNT(walk);
    // The block's lines ahead, and those in its middle. The negative side is also the mask of such blocks.
    int negative_side = -1 << level;
    int negative_half = negative_side >> 1;
    int line_x = (x & negative_side) - negative_side;
    int line_y = (y & negative_side) - negative_side;
    int middle_x = line_x + negative_half;
    int middle_y = line_y + negative_half;
    float cells_x = float(line_x - frame.begin_x);
    float cells_y = float(line_y - frame.begin_y);
    float negative_half_cells = float(negative_half);
    float tx = scarp_lean_line(cells_x, frame.per_x, origin_x);
    float ty = scarp_lean_line(cells_y, frame.per_y, origin_y);
    float tx_middle = scarp_lean_line(cells_x + negative_half_cells, frame.per_x, origin_x);
    float ty_middle = scarp_lean_line(cells_y + negative_half_cells, frame.per_y, origin_y);
    uvec2 quad = scarp_quad(level, (x ^ frame.mirror_x) >> level, (y ^ frame.mirror_y) >> level);
    at.fetches += 1u;
    // The codes of its children: near and far along x, then y.
    uint near_row = back_y ? quad.y : quad.x;
    uint far_row = back_y ? quad.x : quad.y;
    float near_west = float(near_row & 0xffffu);
    float near_east = float(near_row >> 16);
    float far_west = float(far_row & 0xffffu);
    float far_east = float(far_row >> 16);
    float code_nn = back_x ? near_east : near_west;
    float code_fn = back_x ? near_west : near_east;
    float code_nf = back_x ? far_east : far_west;
    float code_ff = back_x ? far_west : far_east;
    // The ray passes three of them, from t to t1, to t2, to t3; less where it enters beyond a middle line.
    bool far_x = x >= middle_x;
    bool far_y = y >= middle_y;
    float t3 = max(t, min(min(tx, ty), last));
    float to_x = far_x ? t3 : clamp(tx_middle, t, t3);
    float to_y = far_y ? t3 : clamp(ty_middle, t, t3);
    bool x_first = to_x <= to_y;
    float t1 = min(to_x, to_y);
    float t2 = max(to_x, to_y);
    float code_x = far_y ? code_ff : code_fn;
    float code_y = far_x ? code_ff : code_nf;
    float code0 = far_x ? code_x : (far_y ? code_nf : code_nn);
    float code1 = x_first ? code_x : code_y;
    float z0 = code_z + code_dz * t;
    float z1 = code_z + code_dz * t1;
    float z2 = code_z + code_dz * t2;
    float z3 = code_z + code_dz * t3;
    bool clear0 = min(z0, z1) > code0;
    above = above || clear0;
    bool free0 = clear0 || (above && t1 <= t);
    bool free1 = min(z1, z2) > code1 || t2 <= t1;
    bool free2 = min(z2, z3) > code_ff || t3 <= t2;
    bool all_free = free0 && free1 && free2;
    float next = free0 ? (free1 ? (free2 ? t3 : t2) : t1) : t;
    bool tests = level == 1 && !all_free;
    bool hole = false;
    if (tests) {
      SCARP_COUNT(cell);
      // The first cell that it may enter: beyond a middle line if it leaves the cell after it. That line may be the
      // field's border, which no ray passes.
      float leave = free0 ? (free1 ? t3 : t2) : t1;
      int cell_x = tx_middle < leave ? middle_x : x;
      int cell_y = ty_middle < leave ? middle_y : y;
      hit_col = cell_x ^ frame.mirror_x;
      hit_row = cell_y ^ frame.mirror_y;
      ScarpLeanCell cell =
          scarp_lean_cell(field, codes.spread, frame, direction, hit_col, hit_row, next, leave, strict);
      at.fetches += 4u;
      bool clear = cell.least > cell.limit || (strict && cell.least == cell.limit);
      bool under = !above && !(cell.above > cell.margin);
      if (under && !cell.hole)
        status = kScarpDoubtful;
      else if (!clear && !cell.hole)
        status = next <= kScarpFreshTime || (any && cell.least < -2.0f * cell.margin) ? kScarpHit : kScarpFrame;
      hole = cell.hole;
      piece = cell.piece;
      if (status == kScarpMiss)
        next = leave;
      else
        last = -1.0f;
    }
    above = (above || tests) && !hole;
    // Into the block at `next`: never back, and across the lines that have been crossed.
    int past_x = tx <= next ? line_x : (tx_middle <= next ? middle_x : x);
    int past_y = ty <= next ? line_y : (ty_middle <= next ? middle_y : y);
    int at_x = frame.begin_x + int(frame.ox + frame.dx * next);
    int at_y = frame.begin_y + int(frame.oy + frame.dy * next);
    x = min(max(max(at_x, past_x), x), frame.last_x);
    y = min(max(max(at_y, past_y), y), frame.last_y);
    t = next;
    level = clamp(level + (all_free ? 1 : -1), 1, field.top_level);
    turn += 1;
  } while (t < last && turn < kScarpLeanTurns);
  at.turns = turn;
  at.above = above ? 1 : 0;
  if (turn >= kScarpLeanTurns) status = kScarpDoubtful;
  float s0 = at.s0;
  if (wraps && status == kScarpMiss && border < end) {
    // Continues into the next copy, by more than the rounding of times.
    at.s0 = (s0 + border) * (1.0f + 4.0f * kScarpUnit);
    status = at.s0 < float(kScarpFarthestCell) ? kScarpFrame : kScarpDoubtful;
  } else if (status == kScarpFrame) {
    // Hits there are decided in a frame that starts there.
    at.s0 = s0 + t;
    // Rounded down, to no later than the sum.
    if (!wraps) at.s0 = uintBitsToFloat((floatBitsToUint(at.s0) - 1u) & kScarpFrameBits);
  }
  hit.status = status;
  hit.steps = uint(turn);
  hit.fetches = at.fetches;
  float from = triangles ? piece.begin : t;
  float t_hit = from + scarp_fall_of(piece, strict) * (piece.end - from);
  hit.cell = ivec2(hit_col, hit_row);
  hit.place = vec2(clamp((frame.place_x - float(hit_col - frame.col)) + direction.x * t_hit, 0.0f, 1.0f),
                   clamp((frame.place_y - float(hit_row - frame.row)) + direction.y * t_hit, 0.0f, 1.0f));
  hit.time = s0;
  hit.time_low = t_hit;
  return status != kScarpFrame;
}

SCARP_GLSL_END

#endif
