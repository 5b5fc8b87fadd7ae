// SPDX-License-Identifier: MIT
// `max-mip` for shaders: the hierarchical traversal of max_mip.h in single precision, closest hit and any hit.
//
//   for each tile of the grid under the ray:     ray_frame.glsl.h: floats count from the tile's corner
//     level 2:  [        ]   lowest ray height over the block > its maximum: leave the block
//     level 1:  [   ][   ]   otherwise: descend one level
//     level 0:  [ ][ ][ ][ ] in a cell: intersect its surface
//
// The integer cell is the state, also between tiles: a tile is entered through the line by which the previous one was
// left. A hit is a sign change between two crossings, each computed once; the next cell inherits the sign. Thus a ray
// cannot slip through a node, an edge or a diagonal.
//
// Guarantee: exact up to rounding: decisions are those for a surface and a ray displaced by at most the bound delta of
// doc/dev/numerics.md ("Single precision"), about 2^-10 of a cell at a tile's far side. Any hit and closest hit always
// agree. Source: see max_mip.h.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0. The including file must define scarp_sample and scarp_is_nodata
// (cell_surface.glsl.h), and
//   float scarp_maximum(int level, int col, int row)   the pyramid's code of a block, level 1 and up; and its minimum,
//   float scarp_minimum(int level, int col, int row)   0 if it has none. As built by accel/max_pyramid.h.
#ifndef SCARP_MARCH_MAX_MIP_GLSL_H
#define SCARP_MARCH_MAX_MIP_GLSL_H

#include "scarp/march/height/cell_surface.glsl.h"
#include "scarp/march/height/ray_frame.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// Side of the ray at the entry of the current cell, as far as known.
const int kScarpUnknown = 0;
const int kScarpAboveGround = 1;
const int kScarpBelowGround = 2;

/// State of the traversal.
struct ScarpWalk {
  ScarpFrame frame;
  int level;
  int col, row;  // of the block on this level
  float t_in;    // time at which the ray entered it, local
  int side;      // kScarpUnknown and so on, at t_in
  int through;   // how the ray entered it
  int begun;     // 1: some cell has been left; only in the first cell can the ray start below
  int start;     // 1: in the cell of a ray from the surface
  float relief;  // relief of the start cell of a ray from the surface; limits the accuracy of its height
};

/// Records a hit in the current cell, at local time t, or at its wall.
SCARP_FN void scarp_tell(ScarpRay ray, ScarpWalk walk, float t, int status, SCARP_INOUT(ScarpHit) hit) {
  hit.status = status;
  hit.cell = ivec2(walk.col, walk.row);
  hit.place = vec2(scarp_place_x(walk.frame, ray, t, walk.col), scarp_place_y(walk.frame, ray, t, walk.row));
  hit.time = walk.frame.s0;
  hit.time_low = t;
}

/// Returns whether a clearance <= 0 is a hit: always, except for rays from the surface, which must be strictly below.
SCARP_FN bool scarp_is_hit(ScarpRay ray, float clearance, float rounding) {
  return clearance <= 0.0f && ((ray.flags & kScarpOnSurface) == 0u || clearance < -rounding);
}

/// Returns whether a ray that is not above can never hit again: falling, below the lowest ground, with no walls ahead.
SCARP_FN bool scarp_lost(ScarpField field, ScarpFrame frame, ScarpRay ray, float t) {
  return ray.direction.z < 0.0f && scarp_ray_height(frame, ray, t) < field.lowest - frame.base &&
         (field.flags & (kScarpHoles | kScarpSolid)) != (kScarpHoles | kScarpSolid);
}

/// Determines the side at the start of a cell where it is unknown: after the start of the ray, a border or a hole,
/// where there is no previous crossing to agree with. Within rounding of the rim a free ray touches it. Returns true if
/// the answer is known.
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

/// Tests the bilinear surface of the current cell, with clearance `out_above` at t_out. Returns true if the answer is
/// known; otherwise walk.side is that of the exit.
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
    // The ray has emerged in between and continues like any ray from above.
    walk.side = kScarpAboveGround;
    falls = scarp_is_hit(ray, out_above, rounding);
  }
  if (!falls) return false;
  // The signs imply a hit in the cell; the quadratic only locates it.
  float s = scarp_falling_root(f);
  scarp_tell(ray, walk, walk.t_in + (s >= 0.0f ? min(s, length) : 0.0f), kScarpHit, hit);
  return true;
}

/// Tests one triangle, from t_begin with clearance `above` (unless walk.side gives its sign) to t_end with clearance
/// `end_above`; it is linear in between. Returns true if the answer is known.
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

/// Tests the two triangles of the current cell: signs at the entry, at the diagonal if crossed, and at the exit.
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

/// Tests the current cell. Returns true if the answer is known.
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

/// Vertical rays that do not start on the surface: one cell, one height.
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

/// Tests the cell in which a ray starts on the surface: above by definition; the root at the start is divided out of
/// the clearance, and the rest decides. Returns true if the answer is known.
SCARP_FN bool scarp_test_start(ScarpField field, ScarpRay ray, ScarpCell cell, int exit, float t_out,
                               SCARP_INOUT(ScarpWalk) walk, SCARP_INOUT(ScarpHit) hit) {
  float high = max(abs(scarp_lowest(cell)), abs(scarp_highest(cell)));
  float rounding = scarp_rounding(walk.frame, ray, t_out, high, walk.relief);
  walk.side = kScarpAboveGround;
  if ((ray.flags & kScarpUpright) != 0u) {
    // A ray straight down is below at once.
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

/// Moves from the current block across its next line, that of a column (through_x) or of a row; into the next tile,
/// with its own frame, if the line ends this one. Returns false if the ray leaves the field, or is too far
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
      // Into another parent block.
      walk.level += 1;
      walk.col >>= 1;
      walk.row >>= 1;
    }
    return true;
  }
  // The next tile or, across the seam, the next copy of the field: at the finest level that is aligned on the other
  // axis.
  int cells = through_x ? field.cells.x : field.cells.y;
  int line = forwards ? end : begin;  // the line crossed, then its number in the next tile
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

/// The start of a traversal.
struct ScarpStart {
  float s;     ///< the ray's time
  ivec2 cell;  ///< in a copy of the field
  ivec2 lap;   ///< where that copy starts
};

/// Where the ray starts.
SCARP_FN ScarpStart scarp_own_start(ScarpRay ray) {
  ScarpStart start;
  start.s = 0.0f;
  start.cell = ray.cell;
  start.lap = ivec2(0, 0);
  return start;
}

/// Starts the traversal of a ray that the caller has clipped: at `start`, which may be later than the ray's own start
/// if the ray has kScarpAbove.
SCARP_FN bool scarp_begin_walk_at(ScarpField field, ScarpStart start, SCARP_INOUT(ScarpRay) ray,
                                  SCARP_INOUT(ScarpWalk) walk, SCARP_INOUT(ScarpHit) hit) {
  bool strict = (ray.flags & kScarpOnSurface) != 0u;
  int top = min(field.top_level, kScarpTileLevel);
  walk.level = 0;
  walk.col = start.cell.x;
  walk.row = start.cell.y;
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
  walk.frame = scarp_frame(field, ray, start.cell, start.lap, start.s);
  if (!strict && (ray.flags & kScarpUpright) != 0u) {
    scarp_upright(field, ray, walk, hit);
    return false;
  }
  // Rays from a distance cross open air first, though blocks that span the field are rarely free.
  if ((ray.flags & (kScarpFromOutside | kScarpAbove)) != 0u) {
    walk.level = max(top - 3, 0);
    walk.col >>= walk.level;
    walk.row >>= walk.level;
  }
  return true;
}

/// Moves the start of a traversal along an axis to the ray's coordinate `at`, in columns or rows from the field's
/// first. Returns false if that is not over the field, or too far.
SCARP_FN bool scarp_start_at(ScarpTwoFloat at, int cells, bool wraps, SCARP_OUT(int) cell, SCARP_OUT(int) lap) {
  float low = wraps ? -float(kScarpFarthestCell) : 0.0f;
  float high = wraps ? float(kScarpFarthestCell) : float(cells);
  cell = 0;
  lap = 0;
  if ((at.high - low) + at.low < 0.0f || (at.high - high) + at.low > 0.0f) return false;
  float whole = floor(at.high);
  cell = int(whole) + int(floor((at.high - whole) + at.low));
  if (wraps) {
    lap = int(floor(float(cell) / float(cells))) * cells;
    // The quotient is rounded.
    if (cell < lap) lap -= cells;
    if (cell >= lap + cells) lap += cells;
    cell -= lap;
  }
  // The last line belongs to the last cell.
  cell = min(cell, cells - 1);
  return true;
}

/// Moves the start of a ray from above down to the highest sample. Returns false if it does not get there over the
/// field; `hit` is then the answer.
SCARP_FN bool scarp_descend(ScarpField field, ScarpRay ray, SCARP_INOUT(ScarpStart) start, SCARP_INOUT(ScarpHit) hit) {
  if (!(ray.direction.z < 0.0f)) return false;
  // The difference, the quotient and the product have an error of 7 units, on devices whose quotients have one of 5:
  // 16 units earlier, the ray is still above.
  float s = (((field.highest - ray.z) - ray.z_low) / ray.direction.z) * (1.0f - 16.0f * kScarpUnit);
  if (!(s <= ray.end)) return false;
  bool wraps = (field.flags & kScarpWraps) != 0u;
  ScarpTwoFloat x =
      scarp_two_line(float(ray.cell.x), ray.place.x, ray.place_low.x, ray.direction.x, ray.direction_low.x, s);
  ScarpTwoFloat y =
      scarp_two_line(float(ray.cell.y), ray.place.y, ray.place_low.y, ray.direction.y, ray.direction_low.y, s);
  start.s = s;
  bool there = scarp_start_at(x, field.cells.x, wraps, start.cell.x, start.lap.x);
  there = scarp_start_at(y, field.cells.y, wraps, start.cell.y, start.lap.y) && there;
  if (!there && wraps) {
    hit.status = kScarpExhausted;
    hit.time = s;
    hit.time_low = 0.0f;
  }
  return there;
}

/// Starts a traversal, that of a ray from above where it descends to the highest sample. For a ray from the surface,
/// computes its height. Returns false if there is nothing to traverse; `hit` is then the answer. `field.top_level` must
/// be at least 1.
SCARP_FN bool scarp_begin_walk(ScarpField field, SCARP_INOUT(ScarpRay) ray, SCARP_INOUT(ScarpWalk) walk,
                               SCARP_INOUT(ScarpHit) hit) {
  ScarpStart start = scarp_own_start(ray);
  if (ray.z > field.highest && (ray.flags & (kScarpOnSurface | kScarpAbove | kScarpUpright)) == 0u) {
    if (!scarp_descend(field, ray, start, hit)) return false;
    ray.flags |= kScarpAbove;
  }
  return scarp_begin_walk_at(field, start, ray, walk, hit);
}

// Look-ahead parameters of any hit, from a search over the rays of scarp-bench gpu (doc/dev/decisions/march.md).
const uint kScarpPatience = 3u;       // traversal steps before the first look-ahead
const float kScarpShortWay = 512.0f;  // cells below the field's top; shorter remaining paths do not repay a look-ahead
const int kScarpProbeLevel = 3;       // blocks of 8 x 8 cells
const int kScarpProbes = 12;
const float kScarpFirstProbe = 8.0f;  // steps in cells
const float kScarpProbeGrowth = 1.5f;

/// Returns whether a ray that is above at local time t is, at some later point, below a whole block: if that has no
/// holes, the ray has crossed the surface before. Samples the minima of one level at growing steps; not for wrapped
/// fields.
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
    // Rounding could place a ray over the field that has left it: by 2^-5 of a cell, as far as probes go (numerics.md).
    if (col < 1 || row < 1 || col > field.cells.x - 2 || row > field.cells.y - 2) return false;
    float code = scarp_minimum(kScarpProbeLevel, col >> kScarpProbeLevel, row >> kScarpProbeLevel);
    hit.fetches += 1u;
    // Or next to this block, where heights may differ by the maximum anywhere.
    float rounding = scarp_rounding(frame, ray, t, all_heights, relief);
    float above = scarp_ray_height(frame, ray, t) - (base + field.code_step * code);
    if (code > 0.0f && above < -2.0f * rounding) return true;
  }
  return false;
}

/// Continues a traversal for some iterations; with `any`, until any hit is certain. Returns false if it is not
/// finished. Hosts whose drivers limit loop iterations interrupt the traversal and continue with the same walk and hit.
SCARP_FN bool scarp_go_on(ScarpField field, ScarpRay ray, bool any, int turns, SCARP_INOUT(ScarpWalk) walk,
                          SCARP_INOUT(ScarpHit) hit) {
  bool holes = (field.flags & kScarpHoles) != 0u;
  bool falling = ray.direction.z < 0.0f;
  int ahead_x = ray.direction.x >= 0.0f ? 1 : 0;
  int ahead_y = ray.direction.y >= 0.0f ? 1 : 0;
  int top = min(field.top_level, kScarpTileLevel);
  for (int turn = 0; turn < turns; ++turn) {
    // The lines through which the ray leaves the block; the last block of a row or column is narrower.
    float tx = scarp_line_x(walk.frame, ray, min((walk.col + ahead_x) << walk.level, field.cells.x));
    float ty = scarp_line_y(walk.frame, ray, min((walk.row + ahead_y) << walk.level, field.cells.y));
    bool through_x = tx <= ty;  // a tie: the line of constant column first
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
        // With holes, the last cell may be a hole: the side at the next cell is then unknown. Passing a block's corner
        // does not leave the ground.
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
        // The whole surface in the block is between its bounds.
        float exact = rounding + 16.0f * kScarpUnit * max(maximum - minimum, walk.relief) *
                                     (abs(ray.direction.x * t_out) + abs(ray.direction.y * t_out) + 1.0f);
        float ray_highest = scarp_ray_height(walk.frame, ray, falling ? walk.t_in : t_out);
        if (bounded && walk.side == kScarpBelowGround && ray_highest < minimum - rounding) {
          if (scarp_lost(field, walk.frame, ray, t_out)) return true;
        } else if (bounded && walk.side == kScarpBelowGround && skips && ray_lowest - maximum > exact) {
          walk.side = holes ? kScarpUnknown : kScarpAboveGround;
        } else if (bounded && walk.side == kScarpAboveGround && minimum - ray_lowest > 2.0f * exact) {
          // The ray was above before and is now below the whole block, so it has crossed the surface.
          hit.status = kScarpHit;
          return true;
        } else {
          walk.level -= 1;
          // After a line of constant column, row lines with the same time are still ahead: the order of ties. A middle
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
        // Passing the corner of a hole does not leave the ground.
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

/// Closest hit; with `any`, any hit: only the status is then defined (kScarpHit possibly also for walls).
/// `field.top_level` must be at least 1.
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
