// SPDX-License-Identifier: MIT
// Points on ground and water, for the stages that paint them. GLSL.
#ifndef SCARP_RENDER_TERRAIN_FRAME_PLACE_GLSL_H
#define SCARP_RENDER_TERRAIN_FRAME_PLACE_GLSL_H

/// Metres of the world, x east and y north.
struct ScarpPaintPlace {
  ScarpTwoFloat x, y;
};

ScarpPaintPlace paint_place(ScarpLine line, ScarpTwoFloat t) {
  Settings s = settings();
  ScarpTwoFloat north = scarp_two_add(scarp_two(s.is.last_row), scarp_two_negate(scarp_line_row(line, t)));
  return ScarpPaintPlace(scarp_two_multiply(scarp_line_col(line, t), two(s.is.cell.x, s.is.cell_low.x)),
                         scarp_two_multiply(north, two(s.is.cell.y, s.is.cell_low.y)));
}

ScarpTwoFloat weighed(ScarpPaintPlace place, vec2 high, vec2 low) {
  return scarp_two_combine(two(high.x, low.x), place.x, two(high.y, low.y), place.y, scarp_two(0.0));
}

#endif
