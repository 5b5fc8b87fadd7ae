// SPDX-License-Identifier: MIT
// Rays that a shader generates itself, as exact as those of a host with doubles (march/height/device_ray.h): every
// number is two floats. For frames whose rays are not uploaded.
//
//   line in grid units ──▶ clipped to border, highest sample and end ──▶ ScarpRay of a march ──▶ time on the line
//
// Times are a quotient plus one correction by its remainder, accurate to 2^-44 of the line's coordinates relative to
// sample (0, 0). Positions thus agree with those of a ray in doubles to 2^-24 of a cell at 2^20 cells.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0.
#ifndef SCARP_MARCH_TWO_FLOAT_RAY_GLSL_H
#define SCARP_MARCH_TWO_FLOAT_RAY_GLSL_H

#include "scarp/march/height/ray_frame.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// origin + t direction: columns, rows and sample units from sample (0, 0). The direction is not zero.
struct ScarpLine {
  vec3 origin;
  vec3 origin_low;
  vec3 direction;
  vec3 direction_low;
};

/// A ray of a march, and the mapping of its times to the line: t = begin + time * per_time.
struct ScarpSent {
  int marches;          ///< 0: the ray does not reach the field
  ScarpRay ray;         ///< defined if it marches
  ScarpTwoFloat begin;  ///< on the line
  float per_time;       ///< a power of two
};

/// Coordinates of a line's point.
SCARP_FN ScarpTwoFloat scarp_along(float origin, float origin_low, float direction, float direction_low,
                                   ScarpTwoFloat t) {
  ScarpTwoFloat at = scarp_two_line(0.0f, origin, origin_low, direction, direction_low, t.high);
  SCARP_PRECISE float low = at.low + direction * t.low;
  return scarp_two_sum(at.high, low);
}
/// Position of a line at time t: the column, from column 0.
SCARP_FN ScarpTwoFloat scarp_line_col(ScarpLine line, ScarpTwoFloat t) {
  return scarp_along(line.origin.x, line.origin_low.x, line.direction.x, line.direction_low.x, t);
}
/// The row, from row 0.
SCARP_FN ScarpTwoFloat scarp_line_row(ScarpLine line, ScarpTwoFloat t) {
  return scarp_along(line.origin.y, line.origin_low.y, line.direction.y, line.direction_low.y, t);
}
/// The height in sample units.
SCARP_FN ScarpTwoFloat scarp_line_height(ScarpLine line, ScarpTwoFloat t) {
  return scarp_along(line.origin.z, line.origin_low.z, line.direction.z, line.direction_low.z, t);
}

/// Time at which a coordinate is `at`; its direction is not 0. kScarpNever or its negative if that is far away.
SCARP_FN ScarpTwoFloat scarp_time_at(ScarpTwoFloat at, float origin, float origin_low, float direction,
                                     float direction_low) {
  float quotient = ((at.high - origin) + (at.low - origin_low)) / direction;
  if (!(abs(quotient) < 1.0e15f)) return scarp_two(quotient < 0.0f ? -kScarpNever : kScarpNever);
  ScarpTwoFloat there = scarp_two_line(-at.high, origin, origin_low, direction, direction_low, quotient);
  SCARP_PRECISE float left = there.high + (there.low - at.low);
  return scarp_two_sum(quotient, -left / direction);
}

/// The larger of two times; a if they are equal.
SCARP_FN ScarpTwoFloat scarp_two_later(ScarpTwoFloat a, ScarpTwoFloat b) {
  if (scarp_two_less(a, b)) return b;
  return a;
}
/// The smaller of two times; b if they are equal.
SCARP_FN ScarpTwoFloat scarp_two_earlier(ScarpTwoFloat a, ScarpTwoFloat b) {
  if (scarp_two_less(a, b)) return a;
  return b;
}

/// The time range in which a line is over a field's columns (or rows), 0 to `cells`; empty if begin is after end.
struct ScarpSpan {
  ScarpTwoFloat begin, end;
};
/// The span along one axis, given the line's numbers along it; `cells` is the last grid line.
SCARP_FN ScarpSpan scarp_span(float origin, float origin_low, float direction, float direction_low, float cells) {
  ScarpSpan span;
  if (direction == 0.0f) {
    bool inside = (origin > 0.0f || (origin == 0.0f && origin_low >= 0.0f)) &&
                  (origin < cells || (origin == cells && origin_low <= 0.0f));
    span.begin = scarp_two(inside ? -kScarpNever : kScarpNever);
    span.end = scarp_two(inside ? kScarpNever : -kScarpNever);
    return span;
  }
  ScarpTwoFloat first = scarp_time_at(scarp_two(0.0f), origin, origin_low, direction, direction_low);
  ScarpTwoFloat last = scarp_time_at(scarp_two(cells), origin, origin_low, direction, direction_low);
  span.begin = scarp_two_earlier(first, last);
  span.end = scarp_two_later(first, last);
  return span;
}
/// The span over the columns.
SCARP_FN ScarpSpan scarp_span_x(ScarpField field, ScarpLine line) {
  return scarp_span(line.origin.x, line.origin_low.x, line.direction.x, line.direction_low.x, float(field.cells.x));
}
/// The span over the rows.
SCARP_FN ScarpSpan scarp_span_y(ScarpField field, ScarpLine line) {
  return scarp_span(line.origin.y, line.origin_low.y, line.direction.y, line.direction_low.y, float(field.cells.y));
}

/// A position along an axis: its cell, and the position in it, 0..1, as two floats.
struct ScarpAxisPlace {
  int cell;
  float place, place_low;
};
/// The position of a coordinate relative to sample 0. Beyond the border it is the border, or the next copy of a wrapped
/// field.
SCARP_FN ScarpAxisPlace scarp_axis_place(ScarpTwoFloat at, int cells, bool wraps) {
  float whole = floor(at.high);
  ScarpTwoFloat rest = scarp_two_sum(at.high - whole, at.low);
  float carry = floor(rest.high);
  ScarpAxisPlace found;
  found.cell = int(whole) + int(carry);
  found.place = rest.high - carry;
  found.place_low = rest.low;
  if (found.place + found.place_low < 0.0f) {
    // Just short of a line.
    found.cell -= 1;
    found.place += 1.0f;
  }
  if (wraps) {
    found.cell -= int(floor(float(found.cell) / float(cells))) * cells;
    // The quotient is rounded.
    if (found.cell < 0) found.cell += cells;
    if (found.cell >= cells) found.cell -= cells;
  } else if (found.cell < 0 || found.cell >= cells) {
    found.place = found.cell < 0 ? 0.0f : 1.0f;
    found.place_low = 0.0f;
    found.cell = found.cell < 0 ? 0 : cells - 1;
  }
  return found;
}

/// The largest power of two that is at most |a|; 2^-125 <= |a| < 2^126.
SCARP_FN float scarp_power_below(float a) { return uintBitsToFloat(floatBitsToUint(a) & 0x7f800000u); }
/// 1 / scarp_power_below(a), exact.
SCARP_FN float scarp_per_power_below(float a) {
  return uintBitsToFloat(0x7f000000u - (floatBitsToUint(a) & 0x7f800000u));
}

/// Options for the march of a line.
const uint kScarpSendSampled = 1u;      ///< by a sampling march: not clipped to the highest sample
const uint kScarpSendFromSurface = 2u;  ///< from the surface of the given cell; z is read by sampling marches

/// Returns the ray of a line from time `begin`, which is 0 from the surface, to `end`, which may be kScarpNever unless
/// the field wraps. `cell` and `place` are read only for rays from the surface.
SCARP_FN ScarpSent scarp_send(ScarpField field, ScarpLine line, ScarpTwoFloat begin, ScarpTwoFloat end, uint how,
                              ivec2 cell, vec2 place) {
  bool wraps = (field.flags & kScarpWraps) != 0u;
  bool sampled = (how & kScarpSendSampled) != 0u;
  bool strict = (how & kScarpSendFromSurface) != 0u;
  ScarpSent sent;
  sent.marches = 0;
  sent.per_time = 1.0f;
  sent.begin = begin;
  ScarpRay ray;
  ray.flags = strict ? kScarpOnSurface : 0u;
  ray.cell = cell;
  ray.place = place;
  ray.place_low = vec2(0.0f, 0.0f);
  ScarpTwoFloat way = end;
  ScarpTwoFloat exit_x = scarp_two(kScarpNever);
  ScarpTwoFloat exit_y = exit_x;
  if (!wraps) {
    ScarpSpan x = scarp_span_x(field, line);
    ScarpSpan y = scarp_span_y(field, line);
    exit_x = x.end;
    exit_y = y.end;
    way = scarp_two_earlier(way, scarp_two_earlier(x.end, y.end));
    if (strict) {
      // It is over its cell by definition.
      way = scarp_two_later(way, sent.begin);
    } else {
      ScarpTwoFloat border = scarp_two_later(x.begin, y.begin);
      if (!scarp_two_less(border, sent.begin)) {
        ray.flags |= kScarpFromOutside;
        sent.begin = border;
      }
      if (scarp_two_less(way, sent.begin) || sent.begin.high >= kScarpNever) {
        sent.ray = ray;
        return sent;
      }
    }
  }
  float dz = line.direction.z;
  if (sampled) {
    if (way.high >= kScarpNever) {
      // Upright: down to the lowest ground.
      float ground = dz > 0.0f ? field.highest : field.lowest;
      way = scarp_time_at(scarp_two(ground), line.origin.z, line.origin_low.z, dz, line.direction_low.z);
    }
    if (scarp_two_less(way, sent.begin)) {
      sent.ray = ray;
      return sent;
    }
  } else if (!strict) {
    ScarpTwoFloat z = scarp_line_height(line, sent.begin);
    if (z.high > field.highest || (z.high == field.highest && z.low > 0.0f)) {
      ScarpTwoFloat top = scarp_two(kScarpNever);
      if (dz < 0.0f) {
        top = scarp_time_at(scarp_two(field.highest), line.origin.z, line.origin_low.z, dz, line.direction_low.z);
        // A peak that the ray only touches is still ahead.
        top.low -= abs(top.high) * 9.0949470177292824e-13f;  // 2^-40
      }
      if (scarp_two_less(way, top)) {
        sent.ray = ray;
        return sent;
      }
      ray.flags |= kScarpAbove;
      sent.begin = scarp_two_later(sent.begin, top);
    }
  }
  ScarpTwoFloat height = scarp_line_height(line, sent.begin);
  if (!strict) {
    ScarpAxisPlace x = scarp_axis_place(scarp_line_col(line, sent.begin), field.cells.x, wraps);
    ScarpAxisPlace y = scarp_axis_place(scarp_line_row(line, sent.begin), field.cells.y, wraps);
    ray.cell = ivec2(x.cell, y.cell);
    ray.place = vec2(x.place, y.place);
    ray.place_low = vec2(x.place_low, y.place_low);
  }
  vec3 d = line.direction;
  vec3 d_low = line.direction_low;
  ScarpTwoFloat over = scarp_two_add(way, scarp_two_negate(sent.begin));
  // max-mip finds the border by its lines; samples must not lie beyond it.
  ScarpTwoFloat rest = sampled ? over : scarp_two_add(end, scarp_two_negate(sent.begin));
  if (!sampled) {
    // The remaining part: only walls can be hit above or below all ground.
    float relief = max(field.highest - field.lowest, 1.0f);
    bool walls = (field.flags & (kScarpHoles | kScarpSolid)) == (kScarpHoles | kScarpSolid);
    bool endless = over.high >= 0.5f * kScarpNever;
    float low_way = over.high;
    if (dz < 0.0f && (endless || !walls)) low_way = (max(height.high - field.lowest, 0.0f) + relief) / -dz;
    if (dz > 0.0f) low_way = (max(field.highest - height.high, 0.0f) + relief) / dz;
    if (endless) rest = scarp_two(low_way);
    float moving = min(over.high, low_way);
    // A ray that moves by less than 2^-40 of a cell counts as not moving, and never reaches a border.
    if (abs(d.x) * moving < 9.0949470177292824e-13f) {
      d.x = 0.0f;
      d_low.x = 0.0f;
      if (!wraps) rest = scarp_two_earlier(rest, scarp_two_add(exit_x, scarp_two_negate(sent.begin)));
    }
    if (abs(d.y) * moving < 9.0949470177292824e-13f) {
      d.y = 0.0f;
      d_low.y = 0.0f;
      if (!wraps) rest = scarp_two_earlier(rest, scarp_two_add(exit_y, scarp_two_negate(sent.begin)));
    }
  }
  float speed = max(abs(d.x), abs(d.y));
  if (sampled) {
    speed = max(speed, abs(dz));
  } else if (speed == 0.0f || speed < abs(dz) * 8.2718061255302767e-25f) {  // 2^-80
    ray.flags |= kScarpUpright;
    d = vec3(0.0f, 0.0f, dz);
    d_low = vec3(0.0f, 0.0f, line.direction_low.z);
    speed = abs(dz);
  }
  float power = scarp_power_below(speed);
  float per = scarp_per_power_below(speed);
  ray.direction = vec3(d.x * per, d.y * per, d.z * per);
  ray.direction_low = vec3(d_low.x * per, d_low.y * per, d_low.z * per);
  ray.per_direction = vec2(d.x == 0.0f ? kScarpNever : clamp(1.0f / ray.direction.x, -kScarpNever, kScarpNever),
                           d.y == 0.0f ? kScarpNever : clamp(1.0f / ray.direction.y, -kScarpNever, kScarpNever));
  ray.z = height.high;
  ray.z_low = height.low;
  ray.end = clamp(rest.high * power, 0.0f, kScarpNever);
  ray.end_low = ray.end > 0.0f && ray.end < kScarpNever ? rest.low * power : 0.0f;
  ray.travelled = sent.begin.high * power;
  ray.exit = ray.end;
  // For a line in metres: the host gives the size of a cell, for marches whose steps count cells.
  ray.per_height = power;
  ray.cell_time = power;
  sent.per_time = per;
  sent.ray = ray;
  sent.marches = 1;
  return sent;
}

/// Returns the time on the line of a march's result.
SCARP_FN ScarpTwoFloat scarp_sent_time(ScarpSent sent, ScarpHit hit) {
  ScarpTwoFloat time = scarp_two_sum(hit.time * sent.per_time, hit.time_low * sent.per_time);
  return scarp_two_add(sent.begin, time);
}

SCARP_GLSL_END

#endif
