// SPDX-License-Identifier: MIT
// Where rays hit water, for the stages that include this: Water::meets(). GLSL.

// Whether a cell is flat ground at the water's level.
bool is_sea(ScarpField field, ivec2 cell) {
  Settings s = settings();
  if (s.is.has_sea == 0) return false;
  ScarpCell h = scarp_cell(field, cell.x, cell.y, 0.0);
  float sea = s.is.sea_sample;
  return !h.hole && h.h00 == sea && h.h10 == sea && h.h01 == sea && h.h11 == sea;
}

bool same_time(ScarpTwoFloat a, ScarpTwoFloat b) { return a.high == b.high && a.low == b.low; }

// The water that a line enters from outside between 0 and `end`.
FrameWater water_on(ScarpField field, ScarpLine line, ScarpTwoFloat end) {
  Settings s = settings();
  FrameWater found;
  found.kind = 0;
  found.t = scarp_two(kScarpNever);
  found.sea = 0;
  found.cell = ivec2(0);
  found.place = vec2(0.0);
  found.normal = vec3(0.0, 0.0, 1.0);
  found.reflectance = 0.0;
  found.glitter = vec3(0.0);
  if (!has_water) return found;
  bool wraps = (field.flags & kScarpWraps) != 0u;
  ScarpTwoFloat level = two(s.is.level_sample, s.is.level_sample_low);
  ScarpTwoFloat from = scarp_two(-kScarpNever);
  ScarpTwoFloat to = scarp_two(kScarpNever);
  ScarpSpan x;
  ScarpSpan y;
  float dz = line.direction.z;
  if (dz == 0.0) {
    ScarpTwoFloat above = scarp_two_add(scarp_line_height(line, scarp_two(0.0)), scarp_two_negate(level));
    if (above.high > 0.0 || wraps) return found;
  } else {
    ScarpTwoFloat plane = scarp_time_at(level, line.origin.z, line.origin_low.z, dz, line.direction_low.z);
    if (dz < 0.0)
      from = plane;
    else
      to = plane;
    if (wraps && dz > 0.0) return found;
  }
  ScarpTwoFloat t = from;
  if (!wraps) {
    // The basin is a box without a floor: the ray enters through the last of its three borders that it crosses.
    x = scarp_span_x(field, line);
    y = scarp_span_y(field, line);
    t = scarp_two_later(from, scarp_two_later(x.begin, y.begin));
    if (!scarp_two_less(t, scarp_two_earlier(to, scarp_two_earlier(x.end, y.end)))) return found;
  }
  if (scarp_two_less(t, scarp_two(0.0)) || scarp_two_less(end, t)) return found;
  ScarpAxisPlace col = scarp_axis_place(scarp_line_col(line, t), field.cells.x, wraps);
  ScarpAxisPlace row = scarp_axis_place(scarp_line_row(line, t), field.cells.y, wraps);
  ivec2 cell = ivec2(col.cell, row.cell);
  vec2 place = vec2(col.place, row.place);
  bool from_above = same_time(t, from);
  ScarpTwoFloat z = level;
  if (!from_above) z = scarp_line_height(line, t);
  ScarpCell ground = scarp_cell(field, cell.x, cell.y, z.high);
  if (ground.hole) return found;
  float surface = scarp_surface(field, ground, place.x, place.y);
  // A ray that hits the level below higher ground comes from below the ground.
  if (from_above && surface > z.low) return found;
  found.t = t;
  found.cell = cell;
  found.place = place;
  if (from_above) {
    found.kind = 1;
    found.sea = is_sea(field, cell) ? 1 : 0;
    return found;
  }
  // A side: only above the ground at that position.
  if (z.low <= surface) return found;
  bool through_x = same_time(t, x.begin);
  found.kind = through_x ? 2 : 3;
  found.normal = through_x ? vec3(line.direction.x > 0.0 ? -1.0 : 1.0, 0.0, 0.0)
                           : vec3(0.0, line.direction.y > 0.0 ? 1.0 : -1.0, 0.0);
  return found;
}
