// SPDX-License-Identifier: MIT
// The first pass of `naive`, `fixed-step`, `relaxed` and `lipschitz` on devices: the rules of naive.glsl.h and so on in
// few instructions, for rays that are above the ground.
//
//   stretch: the ray restarts at time s0; up to kScarpStretch later its points are plain floats
//     turn:  o + d t ──▶ four samples ──▶ clearance ──▶ a hit, or the t of the next point
//
// Left to the second pass (height_marches.glsl.h), with the status kScarpDoubtful: rays that start or enter below the
// ground, and rays with very many points. Everything constant in a turn is computed once per stretch, because drivers
// do not move it out of loops.
//
// Guarantee: that of each march; points are displaced by at most the bound that doc/dev/numerics.md derives ("Marches
// that take samples"). For fields of fewer than 2^17 cells a side.
//
// Compiles as C++ and GLSL. The including file must define what height_marches.glsl.h requires, and scarp_corners
// (max_mip_lean.glsl.h).
#ifndef SCARP_MARCH_HEIGHT_MARCHES_LEAN_GLSL_H
#define SCARP_MARCH_HEIGHT_MARCHES_LEAN_GLSL_H

#include "scarp/march/height/height_marches.glsl.h"
#include "scarp/march/height/lean_place.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Longest stretch, as a time, in which the ray crosses at most twice as many cells.
const float kScarpStretch = 512.0f;
/// A stretch starts this long before its first point, because `relaxed` also steps back.
const float kScarpStretchRoom = 16.0f;
/// Turns of a stretch, and stretches of a ray, before the rest is left to the second pass, which can be interrupted.
/// Invocations of a vector start their stretches together, so its loops take at most the product.
const int kScarpStretchTurns = 1024;
const int kScarpMostStretches = 48;
/// Times per sample unit beyond which products could overflow, and below whose inverse they could underflow.
const float kScarpFlattest = 1.0e15f;

/// Maximum fractions of its time, and of its cell's relief, by which floats lengthen a free distance; numerics.md
/// counts 21 and 15 units.
const float kScarpFreeRounding = 24.0f * kScarpUnit;

/// State of a ray between two stretches.
struct ScarpStretch {
  float s0;        ///< time at which the next stretch starts
  float t;         ///< of the next point, from s0 on; `before`, too
  float before;    ///< of the previous point; this and h_before are defined if `known`
  float h_before;  ///< clearance there
  int steps;       ///< as ScarpMarchState::steps
  int known;       ///< 1: the previous point was over ground
  int opening;     ///< 1: it was over a hole
  int stretches;   ///< so far
};

/// Moves the start of the next stretch to the next point, minus the margin before it: a time of 16 significant bits.
SCARP_FN void scarp_stretch_to(SCARP_INOUT(ScarpStretch) at) {
  float first = max((at.s0 + at.t) - kScarpStretchRoom, 0.0f);
  float s0 = uintBitsToFloat(floatBitsToUint(first) & kScarpFrameBits);
  float moved = s0 - at.s0;
  at.t -= moved;
  at.before -= moved;
  at.s0 = s0;
}

/// The state before the first point.
SCARP_FN ScarpStretch scarp_stretch_begin(ScarpField field, ScarpRay ray, ScarpSampling settings) {
  ScarpMarchState state = scarp_sampled_begin(field, ray, settings);
  ScarpStretch at;
  at.s0 = 0.0f;
  at.t = state.s;
  at.before = 0.0f;
  at.h_before = 0.0f;
  at.steps = state.steps;
  at.known = (state.phase & kScarpKnown) != 0u ? 1 : 0;
  at.opening = 0;
  at.stretches = 0;
  scarp_stretch_to(at);
  return at;
}

/// The ray along an axis in a stretch: o + d t cells from the first line of `cell`.
struct ScarpStretchAxis {
  int cell;
  float o, d;
};

/// The axis from the ray's position at the frame's start, up to local time `last`. In between, the ray is within the
/// field unless the field wraps: at borders o and d are corrected for rounding beyond them.
SCARP_FN ScarpStretchAxis scarp_stretch_axis(ScarpLeanAxis begin, float direction, float last, int cells, bool wraps) {
  ScarpStretchAxis axis;
  axis.cell = begin.cell;
  axis.o = begin.place;
  axis.d = direction;
  if (!wraps) {
    axis.o = min(begin.place, 1.0f - kScarpUnit);
    SCARP_PRECISE float end = fma(direction, last, axis.o);
    float inside = clamp(end, float(-axis.cell), float(cells - axis.cell) * (1.0f - kScarpUnit));
    if (inside != end) axis.d = (inside - axis.o) / last * (1.0f - 4.0f * kScarpUnit);
  }
  return axis;
}

/// The constants of a stretch.
struct ScarpStretchFrame {
  ScarpStretchAxis x, y;
  float base;   ///< heights count from it
  float z, dz;  ///< of the ray: z + dz t
  // A clearance is a hit of naive and relaxed below max(lowest, tolerance * t + offset).
  float lowest, tolerance, offset;
};

/// The frame from time s0 on, up to local time `last`.
SCARP_FN ScarpStretchFrame scarp_stretch_frame(ScarpField field, ScarpRay ray, ScarpWay way, ScarpSampling settings,
                                               float s0, float last) {
  bool wraps = (field.flags & kScarpWraps) != 0u;
  ScarpStretchFrame frame;
  ScarpLeanAxis x = scarp_lean_axis(ray.cell.x, ray.place.x, ray.place_low.x, ray.direction.x, ray.direction_low.x, s0,
                                    field.cells.x, wraps);
  ScarpLeanAxis y = scarp_lean_axis(ray.cell.y, ray.place.y, ray.place_low.y, ray.direction.y, ray.direction_low.y, s0,
                                    field.cells.y, wraps);
  frame.x = scarp_stretch_axis(x, ray.direction.x, last, field.cells.x, wraps);
  frame.y = scarp_stretch_axis(y, ray.direction.y, last, field.cells.y, wraps);
  ScarpTwoFloat height = scarp_lean_height(ray.z, ray.z_low, ray.direction.z, ray.direction_low.z, s0, wraps);
  frame.base = height.high;
  frame.z = height.low;
  frame.dz = ray.direction.z;
  float margin = scarp_start_margin(way, settings);
  frame.lowest = margin > 0.0f ? -kScarpNever : settings.height;
  // Precise, so that compilers do not move these computations back into the turn.
  SCARP_PRECISE float tolerance = settings.tolerance / way.per_clearance;
  SCARP_PRECISE float offset = tolerance * (s0 + way.travelled) - margin / way.per_clearance;
  frame.tolerance = tolerance;
  frame.offset = offset;
  return frame;
}

/// A point of a ray in a stretch.
struct ScarpStretchPoint {
  bool hole;
  float clearance;
  float relief;    ///< of the cell's corners
  float col, row;  ///< relative to the frame's cell
  float u, v;      ///< position in the cell, 0..1 except for rounding at the border
};

/// Number of a cell in the field.
SCARP_FN int scarp_stretch_cell(int cell, int cells, bool wraps) {
  int found = cell;
  if (wraps) {
    found -= int(floor(float(found) / float(cells))) * cells;
    // The quotient is rounded.
    if (found < 0) found += cells;
    if (found >= cells) found -= cells;
  }
  return found;
}

/// The point at local time t; `back`: possibly before the frame's start.
SCARP_FN ScarpStretchPoint scarp_stretch_point(ScarpField field, ScarpStretchFrame frame, bool back, float t) {
  bool wraps = (field.flags & kScarpWraps) != 0u;
  SCARP_PRECISE float x = fma(frame.x.d, t, frame.x.o);
  SCARP_PRECISE float y = fma(frame.y.d, t, frame.y.o);
  SCARP_PRECISE float z = fma(frame.dz, t, frame.z);
  ScarpStretchPoint point;
  point.col = floor(x);
  point.row = floor(y);
  if (back && !wraps) {
    point.col = clamp(point.col, float(-frame.x.cell), float(field.cells.x - 1 - frame.x.cell));
    point.row = clamp(point.row, float(-frame.y.cell), float(field.cells.y - 1 - frame.y.cell));
  }
  SCARP_PRECISE float u = x - point.col;
  SCARP_PRECISE float v = y - point.row;
  point.u = u;
  point.v = v;
  vec4 h;
  if (wraps) {
    ScarpCell cell = scarp_cell(field, scarp_stretch_cell(frame.x.cell + int(point.col), field.cells.x, wraps),
                                scarp_stretch_cell(frame.y.cell + int(point.row), field.cells.y, wraps), 0.0f);
    h = vec4(cell.h00, cell.h10, cell.h01, cell.h11);
  } else {
    h = scarp_corners(frame.x.cell + int(point.col), frame.y.cell + int(point.row));
  }
  point.hole = (field.flags & kScarpHoles) != 0u &&
               (scarp_is_nodata(h.x) || scarp_is_nodata(h.y) || scarp_is_nodata(h.z) || scarp_is_nodata(h.w));
  point.relief = max(max(h.x, h.y), max(h.z, h.w)) - min(min(h.x, h.y), min(h.z, h.w));
  if ((field.flags & kScarpTriangles) != 0u) {
    bool south_east = u + v > 1.0f;
    SCARP_PRECISE float corner = (south_east ? h.w : h.x) - frame.base;
    SCARP_PRECISE float along_x = south_east ? h.w - h.z : h.y - h.x;
    SCARP_PRECISE float along_y = south_east ? h.w - h.y : h.z - h.x;
    SCARP_PRECISE float from_x = south_east ? u - 1.0f : u;
    SCARP_PRECISE float from_y = south_east ? v - 1.0f : v;
    SCARP_PRECISE float ground = fma(from_x, along_x, fma(from_y, along_y, corner));
    point.clearance = z - ground;
  } else {
    SCARP_PRECISE float corner = h.x - frame.base;
    SCARP_PRECISE float along_x = h.y - h.x;
    SCARP_PRECISE float along_y = h.z - h.x;
    SCARP_PRECISE float twist = (h.w - h.z) - along_x;
    SCARP_PRECISE float ground = fma(u, along_x, fma(v, fma(u, twist, along_y), corner));
    point.clearance = z - ground;
  }
  return point;
}

/// Its cell, and the position in it.
SCARP_FN ScarpPoint scarp_stretch_place(ScarpField field, ScarpStretchFrame frame, ScarpStretchPoint of) {
  bool wraps = (field.flags & kScarpWraps) != 0u;
  ScarpPoint point;
  point.valid = !of.hole;
  point.clearance = of.clearance;
  point.cell = ivec2(scarp_stretch_cell(frame.x.cell + int(of.col), field.cells.x, wraps),
                     scarp_stretch_cell(frame.y.cell + int(of.row), field.cells.y, wraps));
  point.place = vec2(clamp(of.u, 0.0f, 1.0f), clamp(of.v, 0.0f, 1.0f));
  return point;
}

/// Whether naive, fixed-step or relaxed hit at a point over ground; `strict`: excludes touches.
SCARP_FN bool scarp_stretch_stops(ScarpSampling settings, ScarpStretchFrame frame, bool strict, float t,
                                  float clearance) {
  bool stops;
  if (settings.march == kScarpFixedStep) {
    stops = clearance < 0.0f || (!strict && clearance == 0.0f);
  } else {
    SCARP_PRECISE float limit = max(frame.lowest, fma(frame.tolerance, t, frame.offset));
    stops = (settings.march == kScarpNaive ? clearance : abs(clearance)) < limit;
  }
  return stops;
}

/// The local time of the refined hit between `before` and `t`; at most kScarpStretch before the frame.
SCARP_FN float scarp_stretch_refined(ScarpField field, ScarpSampling settings, ScarpStretchFrame frame, bool strict,
                                     float before, float h_before, float t, float clearance,
                                     SCARP_INOUT(ScarpHit) hit) {
  float from = before;
  float to = t;
  if (settings.refinement == kScarpRefineBisect) {
    for (int i = 0; i < settings.halvings; ++i) {
      float middle = 0.5f * (from + to);
      ScarpStretchPoint point = scarp_stretch_point(field, frame, true, middle);
      if (!point.hole && scarp_stretch_stops(settings, frame, strict, middle, point.clearance))
        to = middle;
      else
        from = middle;
    }
    hit.steps += uint(settings.halvings);
    hit.fetches += 4u * uint(settings.halvings);
  } else if (h_before != clearance) {
    float limit = 0.0f;
    if (settings.march != kScarpFixedStep) limit = max(frame.lowest, fma(frame.tolerance, t, frame.offset));
    // `relaxed` may come from above or, having overshot, from below.
    if (settings.march == kScarpRelaxed && h_before < 0.0f) limit = -limit;
    to = from + (to - from) * clamp((h_before - limit) / (h_before - clearance), 0.0f, 1.0f);
  }
  return to;
}

/// Follows the ray through one stretch. Returns true if `hit` is the answer; its status may be kScarpDoubtful.
/// Otherwise call again. With `any`, only the status is defined.
SCARP_FN bool scarp_stretch_on(ScarpField field, ScarpRay ray, ScarpSampling settings, bool any,
                               SCARP_INOUT(ScarpStretch) at, SCARP_INOUT(ScarpHit) hit) {
  SCARP_COUNT(frame);
  ScarpWay way = scarp_way(field, ray, settings);
  bool holes = (field.flags & kScarpHoles) != 0u;
  bool is_naive = settings.march == kScarpNaive;
  bool is_fixed = settings.march == kScarpFixedStep;
  bool is_relaxed = settings.march == kScarpRelaxed;
  bool is_lipschitz = settings.march == kScarpLipschitz;
  bool refines = settings.refinement != kScarpRefineNone && !is_lipschitz && !any;
  bool climbs = is_lipschitz && holes;
  bool strict = way.from_surface;
  float least = is_naive ? scarp_naive_least(way, settings) : 0.0f;
  float step_factor = settings.factor * way.per_clearance;
  float limit_offset = settings.tolerance * (at.s0 + way.travelled);  // of lipschitz
  SCARP_PRECISE float end = min((ray.end - at.s0) + ray.end_low, ray.exit - at.s0);
  float last = min(end, kScarpStretch);
  ScarpStretchFrame frame = scarp_stretch_frame(field, ray, way, settings, at.s0, last);
  int most =
      min(climbs ? kScarpStretchTurns / (2 + 2 * field.top_level) : kScarpStretchTurns, settings.max_steps - at.steps);
  bool usual = ray.per_height < kScarpFlattest && ray.per_height > 1.0f / kScarpFlattest;
  bool doubtful = !usual || most < 1 || at.stretches == kScarpMostStretches || !(at.s0 < float(kScarpFarthestCell)) ||
                  (refines && at.before < -kScarpStretch);
  bool done = doubtful || !(at.t <= end);
  if (!done) {
    // naive hits at once if it starts below the ground; fixed-step hits from the surface wherever it gets below.
    bool first_opens = true;
    if (is_naive) first_opens = (ray.flags & kScarpFromOutside) != 0u;
    if (is_fixed) first_opens = !strict;
    bool opening = at.opening != 0;
    if (at.stretches == 0) opening = first_opens;
    bool known = at.known != 0;
    float before = at.before;
    float h_before = at.h_before;
    float t = at.t;
    float next = at.t;
    int turn = 0;
    bool stops = false;
    ScarpStretchPoint point;
    point.hole = false;
    point.clearance = 0.0f;
    point.relief = 0.0f;
    point.col = 0.0f;
    point.row = 0.0f;
    point.u = 0.0f;
    point.v = 0.0f;
    // Tested first, so that everything used after the loop is carried from turn to turn (vk/loop_turns.glsl.h).
    while (!stops && next <= last && turn < most && (!is_relaxed || next >= 0.0f)) {
      SCARP_COUNT(probe);
      if (turn > 0) {
        known = !point.hole;
        if (holes || is_relaxed) opening = point.hole;
        if (refines) h_before = point.clearance;
        if (refines || is_fixed) before = t;
      }
      t = next;
      point = scarp_stretch_point(field, frame, false, t);
      if (is_lipschitz) {
        // Reduced by the displacement of the point in floats and by rounding up, as a time.
        SCARP_PRECISE float free = point.clearance * step_factor;
        SCARP_PRECISE float freed =
            fma(t + free, 1.0f - kScarpFreeRounding, -kScarpFreeRounding * (point.relief * step_factor));
        next = freed;
        stops = free <= fma(settings.tolerance, t, limit_offset) || !(next > t);
      } else {
        stops = scarp_stretch_stops(settings, frame, strict, t, point.clearance);
      }
      if (is_naive) next = t + max(abs(point.clearance) * step_factor, least);
      if (is_fixed) next = t < end ? min(fma(float(at.steps + turn + 1), way.stride, -at.s0), end) : kScarpNever;
      if (is_relaxed) next = max(fma(point.clearance, step_factor, t), -at.s0);
      if (is_relaxed || holes) stops = stops || (opening && point.clearance < 0.0f);
      if (holes) {
        if (climbs) {
          ScarpPoint place = scarp_stretch_place(field, frame, point);
          float until = scarp_bounded_until(field, ray, place, t, hit.fetches);
          next = point.hole ? until : min(next, until);
        }
        if (is_naive && point.hole) next = t + least;
        if (is_relaxed && point.hole) next = t + way.blind;
        stops = stops && !point.hole;
      }
      ++turn;
    }
    if (!holes && !is_relaxed) opening = first_opens && at.stretches == 0 && turn == 1;
    hit.steps += uint(turn);
    hit.fetches += 4u * uint(turn);
    done = stops || !(next <= end);
    if (stops) {
      SCARP_COUNT(hit);
      bool sunk = point.clearance < 0.0f;
      doubtful = opening && sunk;
      hit.status = is_lipschitz && sunk && settings.proven != 0u ? kScarpExhausted : kScarpHit;
      if (!any) {
        // fixed-step from the surface has no interval to refine at its start.
        if (refines && known && (!is_fixed || h_before > 0.0f)) {
          float refined =
              scarp_stretch_refined(field, settings, frame, strict, before, h_before, t, point.clearance, hit);
          ScarpStretchPoint there = scarp_stretch_point(field, frame, true, refined);
          hit.fetches += 4u;
          t = there.hole ? t : refined;
          if (!there.hole) point = there;
        }
        ScarpPoint place = scarp_stretch_place(field, frame, point);
        hit.cell = place.cell;
        hit.place = place.place;
        hit.time = at.s0;
        hit.time_low = t;
      }
    } else {
      at.steps += turn;
      if (!done && at.steps == settings.max_steps) {
        done = true;
        hit.status = kScarpExhausted;
        hit.time = at.s0;
        hit.time_low = is_fixed ? t : next;
      }
      at.before = t;
      at.h_before = point.clearance;
      at.t = next;
      at.known = point.hole ? 0 : 1;
      at.opening = point.hole ? 1 : 0;
      at.stretches += 1;
      scarp_stretch_to(at);
    }
  }
  if (doubtful) hit.status = kScarpDoubtful;
  return done;
}

SCARP_GLSL_END

#endif
