// SPDX-License-Identifier: MIT
// The first pass of `max-mip` on devices: the traversal of max_mip.h in plain floats, with a margin for their error.
//
//   frame: the ray begins anew at time s0, mirrored so that it goes towards +x and +y
//     walk, a block per turn:  one load: the maxima of its 2 x 2 children (GroundQuads)
//       the ray is above every child on its way by more than the margin   leave the block, go up a level
//       else                                                              on to the first child that it may meet
//     in a cell:  above by more than the margin                           leave the cell
//                 else, more than a few cells from the frame's begin      a new frame that begins here
//                 else                                                    the sign of the clearance decides
//
// A frame begins at a point that two floats give exactly, and in its first cells floats are exact to 2^-18 of a cell.
// So a hit is decided and located there, whatever the ray's length, and the margin only costs a new frame for rays that
// graze the ground. A ray that starts below the surface, or enters it from a hole, is left to the exact text
// (max_mip.glsl.h) in a second pass: the status is then kScarpDoubtful.
//
// Guarantee: decisions are those of a surface and a ray displaced by at most the bound that doc/dev/numerics.md
// derives ("The lean pass"); closest and any hit agree. Source: see max_mip.h.
//
// Compiles as C++ and GLSL. The including file defines scarp_sample and scarp_is_nodata (cell_surface.glsl.h), and
//   uvec2 scarp_quad(int level, int col, int row)   codes of the 2 x 2 children of a block, level 1 and up:
//                                                   .x: (0, 0) | (1, 0) << 16, .y: (0, 1) | (1, 1) << 16
#ifndef SCARP_MARCH_MAX_MIP_LEAN_GLSL_H
#define SCARP_MARCH_MAX_MIP_LEAN_GLSL_H

#include "scarp/march/height/cell_surface.glsl.h"
#include "scarp/march/height/ray_frame.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Local time up to which signs decide. At most twice as many cells.
const float kScarpFreshTime = 4.0f;
/// Blocks and cells after which a ray is left to the second pass, which can be interrupted.
const int kScarpLeanTurns = 16384;
/// Height of a block's code that floats may be off, in codes (numerics.md counts 0.27).
const float kScarpCodeRounding = 0.5f;
/// Codes per time beyond which floats could overflow.
const float kScarpSteepest = 1.0e15f;
/// Codes above or below the lowest one at which a ray may begin.
const float kScarpFarthestCode = 1.0e6f;

/// Relief of a field beyond which floats could overflow.
const float kScarpMostRelief = 1.0e30f;

/// State of a ray between two frames.
struct ScarpLean {
  float s0;   ///< time at which the next frame begins; 0: it is the ray's first
  int above;  ///< 1: the ray is known to be above the surface at s0
  int turns;  ///< so far
};

/// Code of one of the four children in a quad.
SCARP_FN float scarp_code_of(uvec2 quad, int child) {
  uint word = (child & 2) != 0 ? quad.y : quad.x;
  return float((word >> ((child & 1) << 4)) & 0xffffu);
}

/// The state before the first frame.
SCARP_FN ScarpLean scarp_lean_begin(ScarpRay ray) {
  ScarpLean at;
  at.s0 = 0.0f;
  at.above = (ray.flags & (kScarpAbove | kScarpOnSurface)) != 0u ? 1 : 0;
  at.turns = 0;
  return at;
}

/// Frames begin at multiples of this time, except over fields that wrap: s0 then has at most 16 significant bits, up to
/// 2^14 cells.
const float kScarpFrameQuantum = 0.25f;

/// a * s0 as two floats, to 2^-32 of itself. For a multiple of the quantum the high 8 bits of `a` give an exact
/// product.
SCARP_FN ScarpTwoFloat scarp_lean_product(float a, float s0, bool wraps) {
  if (wraps) return scarp_two_product(a, s0);
  float high = uintBitsToFloat(floatBitsToUint(a) & 0xffff0000u);
  ScarpTwoFloat product;
  product.high = high * s0;
  product.low = (a - high) * s0;
  return product;
}

/// A place along an axis: a cell of the grid, and 0..1 from where the ray enters that cell's column or row.
struct ScarpLeanAxis {
  int cell;
  float place;
};

/// Where the ray is at time s0.
SCARP_FN ScarpLeanAxis scarp_lean_axis(int cell, float place, float place_low, float direction, float direction_low,
                                       float s0, int cells, bool wraps) {
  ScarpTwoFloat product = scarp_lean_product(direction, s0, wraps);
  float way = product.high;
  float way_low = product.low;
  float whole = floor(way);
  float whole_low = floor(way_low);
  SCARP_PRECISE float rest = (way - whole) + (way_low - whole_low) + (place + (direction_low * s0 + place_low));
  // A ray that begins on a line, or follows one, belongs to the cell that it is given in.
  float carry = s0 == 0.0f || direction == 0.0f ? 0.0f : floor(rest);
  ScarpLeanAxis found;
  found.cell = cell + int(whole) + int(whole_low) + int(carry);
  found.place = clamp(rest - carry, 0.0f, 1.0f);
  if (wraps) {
    found.cell -= int(floor(float(found.cell) / float(cells))) * cells;
    // The quotient is rounded.
    if (found.cell < 0) found.cell += cells;
    if (found.cell >= cells) found.cell -= cells;
  } else {
    found.cell = clamp(found.cell, 0, cells - 1);
  }
  if (direction < 0.0f) found.place = 1.0f - found.place;
  // The line ahead is ahead, so that what lies before it is tested; except for rays that begin on it.
  if (s0 > 0.0f || direction == 0.0f) found.place = min(found.place, 1.0f - kScarpUnit);
  return found;
}

/// The clearance of a ray over a piece of a cell: above + (chord - bend) s + bend s^2, s from 0 to 1.
struct ScarpPiece {
  float begin, end;  ///< local times
  float above;
  float chord;
  float bend;
};

/// The s at which the clearance of a piece falls to 0. A free ray that is at 0 when it begins hits there; one that
/// starts on the surface hits where it comes down again.
SCARP_FN float scarp_fall_of(ScarpPiece piece, bool strict) {
  float slope = piece.chord - piece.bend;
  float root = sqrt(max(0.0f, slope * slope - 4.0f * piece.bend * piece.above));
  float s = 1.0f;
  if (slope < 0.0f)
    s = 2.0f * piece.above / (root - slope);
  else if (piece.bend < 0.0f)
    s = -(slope + root) / (2.0f * piece.bend);
  return piece.above > 0.0f || strict ? clamp(s, 0.0f, 1.0f) : 0.0f;
}

/// Follows the ray through one frame. Returns true if `hit` is the answer; its status may be kScarpDoubtful. Otherwise
/// call again. With `any`, only the status is defined. `field.top_level` must be at least 1.
SCARP_FN bool scarp_lean_on(ScarpField field, ScarpRay ray, bool any, SCARP_INOUT(ScarpLean) at,
                            SCARP_INOUT(ScarpHit) hit) {
  if (!(ray.end >= at.s0)) return true;
  bool strict = (field.flags & kScarpStarts) != 0u && (ray.flags & kScarpOnSurface) != 0u;
  bool wraps = (field.flags & kScarpWraps) != 0u;
  bool triangles = (field.flags & kScarpTriangles) != 0u;
  // The frame.
  float z = ray.z;
  float z_low = ray.z_low;
  float start_relief = 0.0f;
  if (strict) {
    ScarpCell cell = scarp_cell(field, ray.cell.x, ray.cell.y, 0.0f);
    ScarpCell above_node = scarp_cell(field, ray.cell.x, ray.cell.y, cell.h00);
    start_relief = scarp_highest(above_node) - scarp_lowest(above_node);
    z = cell.h00;
    z_low = scarp_surface(field, above_node, ray.place.x, ray.place.y);
  }
  ScarpLeanAxis x = scarp_lean_axis(ray.cell.x, ray.place.x, ray.place_low.x, ray.direction.x, ray.direction_low.x,
                                    at.s0, field.cells.x, wraps);
  ScarpLeanAxis y = scarp_lean_axis(ray.cell.y, ray.place.y, ray.place_low.y, ray.direction.y, ray.direction_low.y,
                                    at.s0, field.cells.y, wraps);
  float dz = ray.direction.z;
  ScarpTwoFloat rise = scarp_lean_product(dz, at.s0, wraps);
  ScarpTwoFloat risen = scarp_two_sum(z, rise.high);
  SCARP_PRECISE float risen_low = risen.low + (rise.low + (ray.direction_low.z * at.s0 + z_low));
  ScarpTwoFloat height = scarp_two_sum(risen.high, risen_low);
  int mirror_x = ray.direction.x < 0.0f ? -1 : 0;
  int mirror_y = ray.direction.y < 0.0f ? -1 : 0;
  int begin_x = x.cell ^ mirror_x;
  int begin_y = y.cell ^ mirror_y;
  float ox = x.place;
  float oy = y.place;
  float dx = abs(ray.direction.x);
  float dy = abs(ray.direction.y);
  float per_x = dx == 0.0f ? kScarpNever : abs(ray.per_direction.x);
  float per_y = dy == 0.0f ? kScarpNever : abs(ray.per_direction.y);
  float base = height.high;
  // In codes, less the margin m(t) = rounding + spread (1 + t).
  float spread = 32.0f * kScarpUnit * field.cell_relief;
  float code_spread = spread * field.code_per_step;
  float code_dz = dz * field.code_per_step;
  float code_z = ((base - field.code_base) + (height.low - field.code_base_low)) * field.code_per_step;
  bool usual = abs(code_dz) < kScarpSteepest && abs(code_z) < kScarpFarthestCode &&
               field.highest - field.lowest < kScarpMostRelief;
  if (!usual || (ray.flags & kScarpUpright) != 0u) {
    hit.status = kScarpDoubtful;
    return true;
  }
  code_z -= kScarpCodeRounding + code_spread;
  code_dz -= code_spread;
  // Up to the border, the ray's end, and where it rises above all ground.
  float border_x = (float((mirror_x == 0 ? field.cells.x : 0) - begin_x) - ox) * per_x;
  float border_y = (float((mirror_y == 0 ? field.cells.y : 0) - begin_y) - oy) * per_y;
  float border = min(border_x, border_y);
  SCARP_PRECISE float end = (ray.end - at.s0) + ray.end_low;
  float over = (field.highest - field.code_base) * field.code_per_step + 1.0f;
  if (code_dz > 0.0f) end = min(end, max(0.0f, (over - code_z) / code_dz));
  float last = min(end, border);

  int swap = (mirror_x & 1) | (mirror_y & 2);
  int cx = begin_x;
  int cy = begin_y;
  int top = field.top_level;
  int level = (at.above != 0 && !strict) || (ray.flags & kScarpFromOutside) != 0u ? max(top - 3, 1) : 1;
  if (at.s0 > 0.0f) level = 1;
  float t = 0.0f;
  bool above = at.above != 0;
  bool found = false;
  bool candidate = false;
  ScarpPiece piece;
  piece.begin = 0.0f;
  piece.end = 0.0f;
  piece.above = 0.0f;
  piece.chord = 0.0f;
  piece.bend = 0.0f;
  int turn = at.turns;
  do {
    int half_side = 1 << (level - 1);
    int line_x = (cx | (2 * half_side - 1)) + 1;
    int line_y = (cy | (2 * half_side - 1)) + 1;
    int middle_x = line_x - half_side;
    int middle_y = line_y - half_side;
    SCARP_PRECISE float tx = (float(line_x - begin_x) - ox) * per_x;
    SCARP_PRECISE float ty = (float(line_y - begin_y) - oy) * per_y;
    SCARP_PRECISE float tx_middle = (float(middle_x - begin_x) - ox) * per_x;
    SCARP_PRECISE float ty_middle = (float(middle_y - begin_y) - oy) * per_y;
    uvec2 quad = scarp_quad(level, (cx ^ mirror_x) >> level, (cy ^ mirror_y) >> level);
    hit.steps += 1u;
    hit.fetches += 1u;
    bool far_x = cx >= middle_x;
    bool far_y = cy >= middle_y;
    // The ray passes three children: from t to t1, to t2, to t3.
    float t3 = max(t, min(min(tx, ty), last));
    float to_x = far_x ? t3 : clamp(tx_middle, t, t3);
    float to_y = far_y ? t3 : clamp(ty_middle, t, t3);
    bool x_first = to_x <= to_y;
    float t1 = min(to_x, to_y);
    float t2 = max(to_x, to_y);
    bool far_x1 = far_x || x_first;
    bool far_y1 = far_y || !x_first;
    float z0 = code_z + code_dz * t;
    float z1 = code_z + code_dz * t1;
    float z2 = code_z + code_dz * t2;
    float z3 = code_z + code_dz * t3;
    int child0 = ((far_x ? 1 : 0) | (far_y ? 2 : 0)) ^ swap;
    int child1 = ((far_x1 ? 1 : 0) | (far_y1 ? 2 : 0)) ^ swap;
    int child2 = 3 ^ swap;
    float code0 = scarp_code_of(quad, child0);
    float code1 = scarp_code_of(quad, child1);
    float code2 = scarp_code_of(quad, child2);
    bool clear0 = min(z0, z1) > code0;
    above = above || clear0;
    bool free0 = clear0 || (above && t1 <= t);
    bool free1 = min(z1, z2) > code1 || t2 <= t1;
    bool free2 = min(z2, z3) > code2 || t3 <= t2;
    bool all_free = free0 && free1 && free2;
    float next = !free0 ? t : !free1 ? t1 : !free2 ? t2 : t3;
    if (level == 1 && !all_free) {
      // The cell of that child.
      float leave = !free0 ? t1 : !free1 ? t2 : t3;
      int cell_x = middle_x - ((free0 ? (free1 || far_x1) : far_x) ? 0 : 1);
      int cell_y = middle_y - ((free0 ? (free1 || far_y1) : far_y) ? 0 : 1);
      // Corners in the ray's direction; over triangles in the grid's, which has the diagonal.
      int col = cell_x ^ mirror_x;
      int row = cell_y ^ mirror_y;
      int next_col = col + 1 < field.samples.x ? col + 1 : 0;
      int next_row = row + 1 < field.samples.y ? row + 1 : 0;
      bool back_x = mirror_x != 0;
      bool back_y = mirror_y != 0;
      bool turned_x = back_x && !triangles;
      bool turned_y = back_y && !triangles;
      float s00 = scarp_sample(turned_x ? next_col : col, turned_y ? next_row : row);
      float s10 = scarp_sample(turned_x ? col : next_col, turned_y ? next_row : row);
      float s01 = scarp_sample(turned_x ? next_col : col, turned_y ? row : next_row);
      float s11 = scarp_sample(turned_x ? col : next_col, turned_y ? row : next_row);
      hit.fetches += 4u;
      bool hole = (field.flags & kScarpHoles) != 0u &&
                  (scarp_is_nodata(s00) || scarp_is_nodata(s10) || scarp_is_nodata(s01) || scarp_is_nodata(s11));
      ScarpCell h;
      h.hole = hole;
      h.h00 = s00 - base;
      h.h10 = s10 - base;
      h.h01 = s01 - base;
      h.h11 = s11 - base;
      float ux = ox - float(cell_x - begin_x);
      float uy = oy - float(cell_y - begin_y);
      float u0 = clamp(ux + dx * next, 0.0f, 1.0f);
      float v0 = clamp(uy + dy * next, 0.0f, 1.0f);
      float u1 = clamp(ux + dx * leave, 0.0f, 1.0f);
      float v1 = clamp(uy + dy * leave, 0.0f, 1.0f);
      float height0 = height.low + dz * next;
      float height1 = height.low + dz * leave;
      piece.begin = next;
      piece.end = leave;
      float size = abs(height.low) + abs(dz) * leave + max(max(abs(h.h00), abs(h.h10)), max(abs(h.h01), abs(h.h11)));
      float margin = 16.0f * kScarpUnit * (size + start_relief) + spread * (1.0f + leave);
      bool fresh = next <= kScarpFreshTime;
      float limit = fresh ? 0.0f : margin;
      if (fresh && strict) {
        // Strictly below, by more than rounding: that of this cell, and of the start's.
        float relief = max(scarp_highest(h) - scarp_lowest(h), start_relief);
        limit = -16.0f * kScarpUnit * (size + (1.0f + 2.0f * leave) * relief);
      }
      float above0;
      float least;
      if (triangles) {
        u0 = back_x ? 1.0f - u0 : u0;
        v0 = back_y ? 1.0f - v0 : v0;
        u1 = back_x ? 1.0f - u1 : u1;
        v1 = back_y ? 1.0f - v1 : v1;
        float beyond0 = (u0 + v0) - 1.0f;
        float beyond1 = (u1 + v1) - 1.0f;
        above0 = height0 - scarp_triangle(h, beyond0 > 0.0f, u0, v0);
        piece.above = above0;
        float end_above = height1 - scarp_triangle(h, beyond1 > 0.0f, u1, v1);
        least = min(piece.above, end_above);
        if ((beyond0 < 0.0f && beyond1 > 0.0f) || (beyond0 > 0.0f && beyond1 < 0.0f)) {
          float share = beyond0 / (beyond0 - beyond1);
          float above_diagonal =
              height0 + share * (height1 - height0) - (h.h10 + (v0 + share * (v1 - v0)) * (h.h01 - h.h10));
          least = min(least, above_diagonal);
          float t_diagonal = next + share * (leave - next);
          // Linear on either side: the fall is before the diagonal if the ray is below there.
          if (min(above0, above_diagonal) > limit) {
            piece.begin = t_diagonal;
            piece.above = above_diagonal;
          } else {
            piece.end = t_diagonal;
            end_above = above_diagonal;
          }
        }
        piece.chord = end_above - piece.above;
        piece.bend = 0.0f;
      } else {
        float along_x = h.h10 - h.h00;
        float along_y = h.h01 - h.h00;
        float twist = (h.h11 - h.h01) - along_x;
        above0 = height0 - (h.h00 + (u0 * along_x + v0 * (along_y + u0 * twist)));
        piece.above = above0;
        float end_above = height1 - (h.h00 + (u1 * along_x + v1 * (along_y + u1 * twist)));
        piece.chord = end_above - piece.above;
        piece.bend = -twist * (u1 - u0) * (v1 - v0);
        least = min(piece.above, end_above);
        if (piece.bend > abs(piece.chord)) {
          float down = piece.chord - piece.bend;
          least = piece.above - down * down / (4.0f * piece.bend);
        }
      }
      if (hole) {
        above = false;
      } else if (!above && !(above0 > margin)) {
        hit.status = kScarpDoubtful;
        return true;
      } else if (!(least > limit || (strict && least == limit))) {
        found = fresh || (any && least < -2.0f * margin);
        candidate = true;
        cx = cell_x;
        cy = cell_y;
        break;
      } else {
        above = true;
      }
      next = leave;
    }
    // Into the block at `next`: never back, and across the lines that have been crossed.
    bool past_x = far_x || tx_middle <= next;
    bool past_y = far_y || ty_middle <= next;
    int low_x = past_x ? max(middle_x, cx) : cx;
    int low_y = past_y ? max(middle_y, cy) : cy;
    cx = tx <= next ? line_x : clamp(begin_x + int(ox + dx * next), low_x, low_x | (half_side - 1));
    cy = ty <= next ? line_y : clamp(begin_y + int(oy + dy * next), low_y, low_y | (half_side - 1));
    t = next;
    level = all_free ? min(level + 1, top) : max(level - 1, 1);
    ++turn;
  } while (t < last && turn < kScarpLeanTurns);
  at.turns = turn + 1;
  at.above = above ? 1 : 0;
  if (turn >= kScarpLeanTurns) {
    hit.status = kScarpDoubtful;
    return true;
  }
  if (found) {
    float t_hit = piece.begin + scarp_fall_of(piece, strict) * (piece.end - piece.begin);
    float u = clamp((ox - float(cx - begin_x)) + dx * t_hit, 0.0f, 1.0f);
    float v = clamp((oy - float(cy - begin_y)) + dy * t_hit, 0.0f, 1.0f);
    hit.status = kScarpHit;
    hit.cell = ivec2(cx ^ mirror_x, cy ^ mirror_y);
    hit.place = vec2(mirror_x == 0 ? u : 1.0f - u, mirror_y == 0 ? v : 1.0f - v);
    hit.time = at.s0;
    hit.time_low = t_hit;
    return true;
  }
  if (candidate) {
    at.s0 += wraps ? piece.begin : floor(piece.begin * (1.0f / kScarpFrameQuantum)) * kScarpFrameQuantum;
    return false;
  }
  if (wraps && border < end) {
    // On into the next copy, by more than times are rounded.
    at.s0 = (at.s0 + border) * (1.0f + 4.0f * kScarpUnit);
    if (!(at.s0 < float(kScarpFarthestCell))) {
      hit.status = kScarpDoubtful;
      return true;
    }
    return false;
  }
  return true;
}

SCARP_GLSL_END

#endif
