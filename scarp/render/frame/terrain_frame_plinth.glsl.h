// SPDX-License-Identifier: MIT
// Walls of the plinth, for the stages that include this: Plinth (plinth.h). GLSL.
//
// Without holes they exist only at the border, where the ray is tested. With holes the march finds them: it treats the
// ground as solid, on the part of the ray above the base.

// The ray's height above the plinth's base at time t.
float above_base(ScarpLine line, ScarpTwoFloat t) {
  Settings s = settings();
  ScarpTwoFloat base = two(s.is.base_sample, s.is.base_sample_low);
  return scarp_two_add(scarp_line_height(line, t), scarp_two_negate(base)).high;
}

// Time at which a ray that is not level passes the base.
ScarpTwoFloat time_at_base(ScarpLine line) {
  Settings s = settings();
  ScarpTwoFloat base = two(s.is.base_sample, s.is.base_sample_low);
  return scarp_time_at(base, line.origin.z, line.origin_low.z, line.direction.z, line.direction_low.z);
}

// A falling ray hits no wall below the base.
void end_at_base(ScarpLine line, inout ScarpTwoFloat end) {
  if (line.direction.z < 0.0) end = scarp_two_earlier(end, time_at_base(line));
}

// Limits the range of a camera ray, from `begin` to `end`, to the plinth, and records a hit on a wall at the border.
// Returns true if the plinth hides the field, by a wall or because the ray falls past it: the march is then
// unnecessary.
bool hidden_by_plinth(ScarpField field, inout ScarpTwoFloat begin, inout ScarpTwoFloat end, inout FrameSeen seen) {
  Settings s = settings();
  ScarpLine line = seen.line;
  ScarpSpan x = scarp_span_x(field, line);
  ScarpSpan y = scarp_span_y(field, line);
  ScarpTwoFloat over = scarp_two_later(scarp_two(0.0), scarp_two_later(x.begin, y.begin));
  if (over.high >= kScarpNever) return true;  // parallel to a side, outside the field
  bool from_below = above_base(line, over) < 0.0;
  if (from_below && line.direction.z <= 0.0) return true;
  // Walls of solid ground end at the base as well.
  if (from_below) begin = time_at_base(line);
  end_at_base(line, end);
  if (has_rims) return false;
  // A rising ray enters through the base and does not hit the ground from below; the march handles this.
  if (from_below) return false;
  // Through a side of constant column, then one of constant row if that is crossed later: the order of ties.
  bool through_x = scarp_two_less(scarp_two(0.0), x.begin) && !scarp_two_less(x.begin, over);
  bool through_y = scarp_two_less(scarp_two(0.0), y.begin) && !scarp_two_less(y.begin, over);
  if (!through_x && !through_y) return false;
  if (scarp_two_less(scarp_two_earlier(end, scarp_two_earlier(x.end, y.end)), over)) return false;
  vec3 direction = line.direction;
  ScarpAxisPlace col = scarp_axis_place(scarp_line_col(line, over), field.cells.x, false);
  ScarpAxisPlace row = scarp_axis_place(scarp_line_row(line, over), field.cells.y, false);
  ivec2 cell = ivec2(col.cell, row.cell);
  vec2 place = vec2(col.place, row.place);
  if (through_x) {
    cell.x = direction.x > 0.0 ? 0 : field.cells.x - 1;
    place.x = direction.x > 0.0 ? 0.0 : 1.0;
  } else {
    cell.y = direction.y > 0.0 ? 0 : field.cells.y - 1;
    place.y = direction.y > 0.0 ? 0.0 : 1.0;
  }
  ScarpTwoFloat z = scarp_line_height(line, over);
  ScarpCell ground = scarp_cell(field, cell.x, cell.y, z.high);
  if (ground.hole) return false;  // the march finds the walls at the rims of holes
  if (z.low > scarp_surface(field, ground, place.x, place.y)) return false;
  seen.kind = kFrameWall;
  seen.t = over;
  seen.cell = cell;
  seen.place = place;
  return true;
}

// The field for a ray that may hit walls at rims.
ScarpField walled(ScarpField field) {
  if (has_rims) field.flags |= kScarpSolid;
  return field;
}

// Whether a ray hits walls: not those at rims if it starts in the solid.
bool meets_walls(ScarpField field, ScarpRay ray) {
  if (!has_rims || (ray.flags & (kScarpFromOutside | kScarpAbove)) != 0u) return true;
  ScarpCell ground = scarp_cell(field, ray.cell.x, ray.cell.y, ray.z);
  return ground.hole || ray.z_low >= scarp_surface(field, ground, ray.place.x, ray.place.y);
}
