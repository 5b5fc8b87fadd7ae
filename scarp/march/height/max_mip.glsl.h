// SPDX-License-Identifier: MIT
// `max-mip` for shaders: the hierarchical walk of max_mip.h in single precision, closest hit and any hit.
//
//   for each tile of the grid under the ray:     ray_frame.glsl.h: floats count from the tile's corner
//     level 2:  [        ]   lowest ray height over the block > its maximum: leave the block at once
//     level 1:  [   ][   ]   otherwise: go one level down
//     level 0:  [ ][ ][ ][ ] in a cell: intersect its surface
//
// The integer cell is the state, also from one tile to the next: a tile is entered through the line that the one before
// was left through. A hit is a change of sign between two crossings, each computed once; the next cell takes the sign
// over. So a ray cannot slip through a node, an edge or a diagonal.
//
// Guarantee: exact, but for rounding: decisions are those of the surface and a ray that are moved by no more than the
// bound delta of doc/dev/numerics.md ("Single precision"), some 2^-10 of a cell at a tile's far side. any-hit and
// closest-hit always agree. Source: see max_mip.h.
//
// Text of C++ and of GLSL, GLSL ES 3.0 included. Who includes it has defined, before, scarp_sample and scarp_is_nodata
// (cell_surface.glsl.h), and
//   float scarp_maximum(int level, int col, int row)   the pyramid's code of a block, level 1 and up; and its minimum,
//   float scarp_minimum(int level, int col, int row)   0 where it has none. As accel/max_pyramid.h builds them.
#ifndef SCARP_MARCH_MAX_MIP_GLSL_H
#define SCARP_MARCH_MAX_MIP_GLSL_H

#include "scarp/march/height/cell_surface.glsl.h"
#include "scarp/march/height/ray_frame.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// Where the ray is at the entry of the current cell, as far as known.
const int kScarpUnknown = 0;
const int kScarpAboveGround = 1;
const int kScarpBelowGround = 2;

/// Where the walk stands.
struct ScarpWalk {
  ScarpFrame frame;
  int level;
  int col, row;  // of the block on this level
  float t_in;    // when the ray came into it, local
  int side;      // kScarpUnknown and so on, at t_in
  int through;   // how it came into it
  int begun;     // 1: something has been left behind; only the first cell can say that the ray began below
  int start;     // 1: in the cell of a ray from the surface
  float relief;  // of the cell that a ray from the surface began in: its height is as exact as that allows
};

/// A hit in the cell where the walk stands, at local time t, or at its wall.
SCARP_FN void scarp_tell(ScarpRay ray, ScarpWalk walk, float t, int status, SCARP_INOUT(ScarpHit) hit) {
  hit.status = status;
  hit.cell = ivec2(walk.col, walk.row);
  hit.place = vec2(scarp_place_x(walk.frame, ray, t, walk.col), scarp_place_y(walk.frame, ray, t, walk.row));
  hit.time = walk.frame.s0;
  hit.time_low = t;
}

/// Whether a clearance of zero or less is a hit: always, but for a ray from the surface, which has to be strictly
/// below.
SCARP_FN bool scarp_is_hit(ScarpRay ray, float clearance, float rounding) {
  return clearance <= 0.0f && ((ray.flags & kScarpOnSurface) == 0u || clearance < -rounding);
}

/// Whether a ray that is not above can never hit again: falling, under the lowest ground, with no walls ahead.
SCARP_FN bool scarp_lost(ScarpField field, ScarpFrame frame, ScarpRay ray, float t) {
  return ray.direction.z < 0.0f && scarp_ray_height(frame, ray, t) < field.lowest - frame.base &&
         (field.flags & (kScarpHoles | kScarpSolid)) != (kScarpHoles | kScarpSolid);
}

/// The question that a cell begins with where the side is not known: after the ray's begin, a border or a hole, where
/// there is no crossing before to agree with. Within rounding of the rim a free ray touches it. True: answered.
SCARP_FN bool scarp_find_side(ScarpField field, ScarpRay ray, ScarpCell cell, float rounding,
                              SCARP_INOUT(ScarpWalk) walk, SCARP_INOUT(ScarpHit) hit) {
  float in_above = scarp_clearance(field, walk.frame, ray, cell, walk.col, walk.row, walk.through, false, walk.t_in);
  bool on_rim = in_above <= 0.0f && -in_above <= rounding;
  if (on_rim && (ray.flags & kScarpOnSurface) == 0u) {
    scarp_tell(ray, walk, walk.t_in, kScarpHit, hit);
    return true;
  }
  walk.side = in_above >= 0.0f || on_rim ? kScarpAboveGround : kScarpBelowGround;
  if (walk.side == kScarpAboveGround) return false;
  if ((field.flags & kScarpSolid) != 0u && (walk.begun != 0 || (ray.flags & kScarpFromOutside) != 0u)) {
    scarp_tell(ray, walk, walk.t_in, kScarpWall, hit);
    return true;
  }
  if (walk.begun == 0) hit.status = kScarpBelow;
  return false;
}

/// The bilinear surface of the current cell, with clearance `out_above` at t_out; true: answered, else walk.side is
/// that of the way out.
SCARP_FN bool scarp_test_bilinear(ScarpRay ray, ScarpCell cell, float out_above, float t_out, float rounding,
                                  SCARP_INOUT(ScarpWalk) walk, SCARP_INOUT(ScarpHit) hit) {
  float length = t_out - walk.t_in;
  ScarpQuadratic f = scarp_quadratic(walk.frame, ray, cell, walk.col, walk.row, walk.t_in);
  bool strict = (ray.flags & kScarpOnSurface) != 0u;
  bool falls = false;
  if (walk.side == kScarpAboveGround) {
    falls = scarp_is_hit(ray, out_above, rounding) || scarp_dips(f, length, strict ? -rounding : 0.0f);
  } else if (out_above > rounding) {
    walk.side = kScarpAboveGround;
  } else if (scarp_peaks(f, length, rounding)) {
    // It has come out in between, and goes on as any ray from above.
    walk.side = kScarpAboveGround;
    falls = scarp_is_hit(ray, out_above, rounding);
  }
  if (!falls) return false;
  // The signs have decided that there is a hit in the cell; the quadratic only says where.
  float s = scarp_falling_root(f);
  scarp_tell(ray, walk, walk.t_in + (s >= 0.0f ? min(s, length) : 0.0f), kScarpHit, hit);
  return true;
}

/// One triangle, from t_begin with clearance `above` (as far as walk.side tells its sign) to t_end with clearance
/// `end_above`; in between it is linear. True: answered.
SCARP_FN bool scarp_test_triangle(ScarpRay ray, float t_begin, float above, float end_above, float t_end,
                                  float rounding, SCARP_INOUT(ScarpWalk) walk, SCARP_INOUT(ScarpHit) hit) {
  if (walk.side == kScarpBelowGround) {
    if (end_above > rounding) walk.side = kScarpAboveGround;
    return false;
  }
  if (!scarp_is_hit(ray, end_above, rounding)) return false;
  float share = above > 0.0f ? above / (above - end_above) : 0.0f;
  scarp_tell(ray, walk, min(t_begin + share * (t_end - t_begin), t_end), kScarpHit, hit);
  return true;
}

/// The two triangles of the current cell: signs at the way in, at the diagonal, if it is crossed, and at the way out.
SCARP_FN bool scarp_test_triangles(ScarpRay ray, ScarpCell cell, float out_above, float t_out, float rounding,
                                   SCARP_INOUT(ScarpWalk) walk, SCARP_INOUT(ScarpHit) hit) {
  float u = scarp_place_x(walk.frame, ray, walk.t_in, walk.col);
  float v = scarp_place_y(walk.frame, ray, walk.t_in, walk.row);
  float beyond_in = (u + v) - 1.0f;
  float beyond_out =
      (scarp_place_x(walk.frame, ray, t_out, walk.col) - 1.0f) + scarp_place_y(walk.frame, ray, t_out, walk.row);
  float t_begin = walk.t_in;
  float above = scarp_ray_height(walk.frame, ray, t_begin) - scarp_triangle(cell, beyond_in > 0.0f, u, v);
  if ((beyond_in < 0.0f && beyond_out > 0.0f) || (beyond_in > 0.0f && beyond_out < 0.0f)) {
    float t = t_begin + (t_out - t_begin) * (beyond_in / (beyond_in - beyond_out));
    SCARP_PRECISE float crossing = scarp_ray_height(walk.frame, ray, t) -
                                   scarp_edge_height(cell.h10, cell.h01, scarp_place_y(walk.frame, ray, t, walk.row));
    if (scarp_test_triangle(ray, t_begin, above, crossing, t, rounding, walk, hit)) return true;
    t_begin = t;
    above = crossing;
  }
  return scarp_test_triangle(ray, t_begin, above, out_above, t_out, rounding, walk, hit);
}

/// The current cell; true: answered.
SCARP_FN bool scarp_test_cell(ScarpField field, ScarpRay ray, ScarpCell cell, int exit, float t_out,
                              SCARP_INOUT(ScarpWalk) walk, SCARP_INOUT(ScarpHit) hit) {
  float low = scarp_lowest(cell);
  float high = scarp_highest(cell);
  float rounding = scarp_rounding(walk.frame, ray, t_out, max(abs(low), abs(high)), max(high - low, walk.relief));
  if (walk.side == kScarpUnknown && scarp_find_side(field, ray, cell, rounding, walk, hit)) return true;
  float out_above = scarp_clearance(field, walk.frame, ray, cell, walk.col, walk.row, exit, true, t_out);
  if ((field.flags & kScarpTriangles) != 0u) {
    if (scarp_test_triangles(ray, cell, out_above, t_out, rounding, walk, hit)) return true;
  } else if (scarp_test_bilinear(ray, cell, out_above, t_out, rounding, walk, hit)) {
    return true;
  }
  return walk.side == kScarpBelowGround && scarp_lost(field, walk.frame, ray, t_out);
}

/// Straight up or down, not from the surface: one cell, one height.
SCARP_FN void scarp_upright(ScarpField field, ScarpRay ray, ScarpWalk walk, SCARP_INOUT(ScarpHit) hit) {
  ScarpCell cell = scarp_cell(field, walk.col, walk.row, walk.frame.base);
  hit.fetches += 4u;
  hit.steps += 1u;
  if (cell.hole) return;
  float ground = scarp_surface(field, cell, scarp_place_x(walk.frame, ray, 0.0f, walk.col),
                               scarp_place_y(walk.frame, ray, 0.0f, walk.row));
  float above = walk.frame.z - ground;
  if (above < 0.0f && (ray.flags & kScarpAbove) == 0u) {
    hit.status = kScarpBelow;
  } else if (above <= 0.0f) {
    scarp_tell(ray, walk, 0.0f, kScarpHit, hit);
  } else if (scarp_ray_height(walk.frame, ray, walk.frame.t_end) <= ground) {
    scarp_tell(ray, walk, min(above / -ray.direction.z, walk.frame.t_end), kScarpHit, hit);
  }
}

/// The cell in which a ray begins on the surface: above by definition, the root at the start is divided out of the
/// clearance, and what is left decides. True: answered.
SCARP_FN bool scarp_test_start(ScarpField field, ScarpRay ray, ScarpCell cell, int exit, float t_out,
                               SCARP_INOUT(ScarpWalk) walk, SCARP_INOUT(ScarpHit) hit) {
  float high = max(abs(scarp_lowest(cell)), abs(scarp_highest(cell)));
  float rounding = scarp_rounding(walk.frame, ray, t_out, high, walk.relief);
  walk.side = kScarpAboveGround;
  if ((ray.flags & kScarpUpright) != 0u) {
    // Straight down is below at once.
    if (ray.direction.z < 0.0f && ray.direction.z * walk.frame.t_end < -rounding) {
      scarp_tell(ray, walk, 0.0f, kScarpHit, hit);
    }
    return true;
  }
  if (!(t_out > walk.t_in)) return false;
  if ((field.flags & kScarpTriangles) != 0u) {
    float out_above = scarp_clearance(field, walk.frame, ray, cell, walk.col, walk.row, exit, true, t_out);
    return scarp_test_triangles(ray, cell, out_above, t_out, rounding, walk, hit);
  }
  float length = t_out - walk.t_in;
  ScarpQuadratic f = scarp_quadratic(walk.frame, ray, cell, walk.col, walk.row, walk.t_in);
  bool dips = f.a > 0.0f && f.b < 0.0f && -f.b < 2.0f * f.a * length;
  float lowest = dips ? -f.b * f.b / (4.0f * f.a) : length * (f.a * length + f.b);
  if (!(lowest < -rounding)) return false;
  scarp_tell(ray, walk, walk.t_in + (f.b < 0.0f || f.a == 0.0f ? 0.0f : min(f.b / -f.a, length)), kScarpHit, hit);
  return true;
}

/// From the block where the walk stands over its next line, which is that of a column (through_x) or of a row; into the
/// next tile, with a frame of its own, where that line ends this one. False: out of the field, or too far
/// (kScarpExhausted).
SCARP_FN bool scarp_step(ScarpField field, ScarpRay ray, bool through_x, int top, SCARP_INOUT(ScarpWalk) walk,
                         SCARP_INOUT(ScarpHit) hit) {
  bool forwards = (through_x ? ray.direction.x : ray.direction.y) >= 0.0f;
  int ahead = forwards ? 1 : 0;
  int next = (through_x ? walk.col : walk.row) + (forwards ? 1 : -1);
  int begin = through_x ? walk.frame.begin.x : walk.frame.begin.y;
  int end = through_x ? walk.frame.end.x : walk.frame.end.y;
  walk.through = through_x ? kScarpLineX : kScarpLineY;
  if (next >= begin >> walk.level && next <= (end - 1) >> walk.level) {
    if (through_x)
      walk.col = next;
    else
      walk.row = next;
    if (walk.level < top && (next & 1) != ahead) {
      // Into another parent.
      walk.level += 1;
      walk.col >>= 1;
      walk.row >>= 1;
    }
    return true;
  }
  // The next tile or, over the seam, the next copy of the field: from the finest level that stands for the other axis.
  int cells = through_x ? field.cells.x : field.cells.y;
  int line = forwards ? end : begin;  // that is crossed, and then as the next tile counts
  ivec2 lap = walk.frame.lap;
  if (line == (forwards ? cells : 0)) {
    if ((field.flags & kScarpWraps) == 0u) return false;
    line = forwards ? 0 : cells;
    if (through_x)
      lap.x += forwards ? cells : -cells;
    else
      lap.y += forwards ? cells : -cells;
    if (abs(lap.x) > kScarpFarthestCell || abs(lap.y) > kScarpFarthestCell) {
      hit.status = kScarpExhausted;
      hit.time = walk.frame.s0;
      hit.time_low = walk.t_in;
      return false;
    }
  }
  int entered = forwards ? line : line - 1;
  int col = through_x ? entered : min(walk.col << walk.level, field.cells.x - 1);
  int row = through_x ? min(walk.row << walk.level, field.cells.y - 1) : entered;
  walk.frame = scarp_frame(field, ray, ivec2(col, row), lap, walk.frame.s0 + walk.t_in);
  walk.t_in = through_x ? scarp_line_x(walk.frame, ray, line) : scarp_line_y(walk.frame, ray, line);
  walk.level = min(walk.level + 1, top);
  walk.col = col >> walk.level;
  walk.row = row >> walk.level;
  return true;
}

/// The begin of a walk. A ray from the surface is told its height. False: there is nothing to walk, `hit` is the
/// answer. `field.top_level` must be 1 or more.
SCARP_FN bool scarp_begin_walk(ScarpField field, SCARP_INOUT(ScarpRay) ray, SCARP_INOUT(ScarpWalk) walk,
                               SCARP_INOUT(ScarpHit) hit) {
  bool strict = (ray.flags & kScarpOnSurface) != 0u;
  int top = min(field.top_level, kScarpTileLevel);
  walk.level = 0;
  walk.col = ray.cell.x;
  walk.row = ray.cell.y;
  walk.t_in = 0.0f;
  walk.side = (ray.flags & kScarpAbove) != 0u ? kScarpAboveGround : kScarpUnknown;
  walk.through = kScarpPoint;
  walk.begun = 0;
  walk.start = strict ? 1 : 0;
  walk.relief = 0.0f;
  if (strict) {
    ScarpCell cell = scarp_cell(field, walk.col, walk.row, 0.0f);
    ScarpCell above_node = scarp_cell(field, walk.col, walk.row, cell.h00);
    walk.relief = scarp_highest(above_node) - scarp_lowest(above_node);
    ray.z = cell.h00;
    ray.z_low = scarp_surface(field, above_node, ray.place.x, ray.place.y);
    hit.fetches += 4u;
  }
  walk.frame = scarp_frame(field, ray, ray.cell, ivec2(0, 0), 0.0f);
  if (!strict && (ray.flags & kScarpUpright) != 0u) {
    scarp_upright(field, ray, walk, hit);
    return false;
  }
  // Rays from afar cross open air first, though blocks that span the field are seldom free.
  if ((ray.flags & (kScarpFromOutside | kScarpAbove)) != 0u) {
    walk.level = max(top - 3, 0);
    walk.col >>= walk.level;
    walk.row >>= walk.level;
  }
  return true;
}

// When and where any-hit looks ahead; from a search over the rays of scarp-bench gpu (doc/dev/decisions.md).
const uint kScarpPatience = 3u;       // steps of the walk before
const float kScarpShortWay = 512.0f;  // cells of way below all ground's top up to which looking costs what it saves
const int kScarpProbeLevel = 3;       // blocks of 8 x 8 cells
const int kScarpProbes = 12;
const float kScarpFirstProbe = 8.0f;  // steps in cells
const float kScarpProbeGrowth = 1.5f;

/// Whether a ray that is above at local time t is, at some point further on, under all of a block: without holes it has
/// been through the surface before, wherever. A look at the minima of one level at ever longer steps; not over a field
/// that wraps round.
SCARP_FN bool scarp_goes_under(ScarpField field, ScarpRay ray, ScarpFrame frame, float t, SCARP_INOUT(ScarpHit) hit) {
  float relief = field.highest - field.lowest;
  float last = frame.t_end;
  if (ray.direction.z > 0.0f) last = min(last, ((field.highest - frame.base) - frame.z) / ray.direction.z);
  float per_cell = 1.0f / max(abs(ray.direction.x), abs(ray.direction.y));
  if (!(last - t > kScarpShortWay * per_cell)) return false;
  float base = (field.code_base - frame.base) + field.code_base_low;
  float all_heights = abs(base) + abs(field.code_step) * 65535.0f;
  float step = kScarpFirstProbe * per_cell;
  for (int i = 0; i < kScarpProbes; ++i) {
    t += step;
    step *= kScarpProbeGrowth;
    if (!(t < last)) return false;
    int col = frame.begin.x + int(floor(frame.o.x + ray.direction.x * t));
    int row = frame.begin.y + int(floor(frame.o.y + ray.direction.y * t));
    // Rounding could have a ray over the field that has left it: by 2^-5 of a cell, as far as probes go (numerics.md).
    if (col < 1 || row < 1 || col > field.cells.x - 2 || row > field.cells.y - 2) return false;
    float code = scarp_minimum(kScarpProbeLevel, col >> kScarpProbeLevel, row >> kScarpProbeLevel);
    hit.fetches += 1u;
    // Or beside this block, where heights differ by as much as they do anywhere.
    float rounding = scarp_rounding(frame, ray, t, all_heights, relief);
    float above = scarp_ray_height(frame, ray, t) - (base + field.code_step * code);
    if (code > 0.0f && above < -2.0f * rounding) return true;
  }
  return false;
}

/// On from where a walk stands, for some turns; with `any`, to the first certainty that anything is met. False: it is
/// not done. Hosts whose drivers limit the turns of loops interrupt it so and go on with the same walk and hit.
SCARP_FN bool scarp_go_on(ScarpField field, ScarpRay ray, bool any, int turns, SCARP_INOUT(ScarpWalk) walk,
                          SCARP_INOUT(ScarpHit) hit) {
  bool holes = (field.flags & kScarpHoles) != 0u;
  bool falling = ray.direction.z < 0.0f;
  int ahead_x = ray.direction.x >= 0.0f ? 1 : 0;
  int ahead_y = ray.direction.y >= 0.0f ? 1 : 0;
  int top = min(field.top_level, kScarpTileLevel);
  for (int turn = 0; turn < turns; ++turn) {
    // The lines that the ray leaves the block through; the last block of a row or column is narrower.
    float tx = scarp_line_x(walk.frame, ray, min((walk.col + ahead_x) << walk.level, field.cells.x));
    float ty = scarp_line_y(walk.frame, ray, min((walk.row + ahead_y) << walk.level, field.cells.y));
    bool through_x = tx <= ty;  // a tie: first through the line of constant column
    float t_line = through_x ? tx : ty;
    float t_out = max(walk.t_in, min(t_line, walk.frame.t_end));
    // The ray's height is linear: lowest at one end of the block.
    float t_lowest = falling ? t_out : walk.t_in;
    float ray_lowest = scarp_ray_height(walk.frame, ray, t_lowest);
    hit.steps += 1u;
    if (walk.level > 0) {
      float base = (field.code_base - walk.frame.base) + field.code_base_low;
      float maximum = base + field.code_step * scarp_maximum(walk.level, walk.col, walk.row);
      float all_heights = abs(base) + abs(field.code_step) * 65535.0f;
      float rounding = scarp_rounding(walk.frame, ray, t_lowest, all_heights, 0.0f);
      bool skips = ray_lowest - maximum > rounding;
      hit.fetches += 1u;
      if (skips && walk.side != kScarpBelowGround) {
        // Where there are holes, the last cell may be one: the next begins with a question. Passing a block's corner is
        // not leaving the ground.
        if (!holes)
          walk.side = kScarpAboveGround;
        else if (t_out > walk.t_in)
          walk.side = kScarpUnknown;
      } else {
        float code = 0.0f;
        float minimum = 0.0f;
        bool bounded = false;
        if (walk.side == kScarpBelowGround || (any && falling && walk.side == kScarpAboveGround)) {
          code = scarp_minimum(walk.level, walk.col, walk.row);
          hit.fetches += 1u;
          minimum = base + field.code_step * code;
          bounded = code > 0.0f;
        }
        // All of the surface in the block is between its bounds.
        float exact = rounding + 16.0f * kScarpUnit * max(maximum - minimum, walk.relief) *
                                     (abs(ray.direction.x * t_out) + abs(ray.direction.y * t_out) + 1.0f);
        float ray_highest = scarp_ray_height(walk.frame, ray, falling ? walk.t_in : t_out);
        if (bounded && walk.side == kScarpBelowGround && ray_highest < minimum - rounding) {
          if (scarp_lost(field, walk.frame, ray, t_out)) return true;
        } else if (bounded && walk.side == kScarpBelowGround && skips && ray_lowest - maximum > exact) {
          walk.side = holes ? kScarpUnknown : kScarpAboveGround;
        } else if (bounded && walk.side == kScarpAboveGround && minimum - ray_lowest > 2.0f * exact) {
          // It was above before, and has come under all of the block: it has been through the surface, wherever.
          hit.status = kScarpHit;
          return true;
        } else {
          walk.level -= 1;
          // After a line of constant column, rows' lines of the same time are still ahead: the order of ties. A middle
          // line beyond the field was crossed with its border.
          int middle_col = (2 * walk.col + 1) << walk.level;
          int middle_row = (2 * walk.row + 1) << walk.level;
          float t_middle_x = scarp_line_x(walk.frame, ray, middle_col);
          float t_middle_y = scarp_line_y(walk.frame, ray, middle_row);
          bool behind_x = middle_col >= field.cells.x ? ahead_x == 0 : t_middle_x <= walk.t_in;
          bool behind_y = middle_row >= field.cells.y   ? ahead_y == 0
                          : walk.through == kScarpLineX ? t_middle_y < walk.t_in
                                                        : t_middle_y <= walk.t_in;
          walk.col = 2 * walk.col + (behind_x ? ahead_x : 1 - ahead_x);
          walk.row = 2 * walk.row + (behind_y ? ahead_y : 1 - ahead_y);
          continue;
        }
      }
    } else {
      ScarpCell cell = scarp_cell(field, walk.col, walk.row, walk.frame.base);
      hit.fetches += 4u;
      int exit = t_line > walk.frame.t_end ? kScarpPoint : through_x ? kScarpLineX : kScarpLineY;
      if (cell.hole) {
        // Passing the corner of a hole is not leaving the ground.
        if (t_line > walk.t_in) walk.side = kScarpUnknown;
        if (scarp_lost(field, walk.frame, ray, walk.t_in)) return true;
      } else if (walk.start != 0) {
        if (scarp_test_start(field, ray, cell, exit, t_out, walk, hit)) return true;
      } else if (ray_lowest > scarp_highest(cell) && walk.side != kScarpBelowGround) {
        walk.side = kScarpAboveGround;
      } else if (scarp_test_cell(field, ray, cell, exit, t_out, walk, hit)) {
        return true;
      }
      walk.start = 0;
    }
    walk.begun = 1;
    if (!falling && ray_lowest > field.highest - walk.frame.base) return true;
    if (!(t_line < walk.frame.t_end)) return true;
    walk.t_in = t_out;
    if (any && hit.steps == kScarpPatience && walk.side == kScarpAboveGround && top >= kScarpProbeLevel &&
        (field.flags & (kScarpHoles | kScarpWraps)) == 0u && scarp_goes_under(field, ray, walk.frame, walk.t_in, hit)) {
      hit.status = kScarpHit;
      return true;
    }
    if (!scarp_step(field, ray, through_x, top, walk, hit)) return true;
  }
  return false;
}

/// What a ray meets first; with `any`, whether it meets anything: then only the status means something (kScarpHit also
/// for walls, perhaps). `field.top_level` must be 1 or more.
SCARP_FN ScarpHit scarp_max_mip(ScarpField field, ScarpRay ray, bool any) {
  ScarpHit hit = scarp_no_hit();
  ScarpWalk walk;
  if (!scarp_begin_walk(field, ray, walk, hit)) return hit;
  while (!scarp_go_on(field, ray, any, kScarpAllTurns, walk, hit)) {
  }
  return hit;
}

SCARP_GLSL_END

#endif
