// SPDX-License-Identifier: MIT
// Heights along a line between two places: the ground at every crossing with a grid line, and whether the eye sees it.
#pragma once

#include <vector>

#include "scarp/analysis/line_of_sight.h"

namespace scarp {

/// One point of a profile: an end, or a crossing with ground.
struct ProfilePoint {
  double along = 0;         ///< 0 at the start, 1 at the end
  double distance = 0;      ///< from the start, metres
  double col = 0, row = 0;  ///< its position
  double ground = 0;        ///< metres above sea; NaN at an end on a hole
  double drop = 0;          ///< metres by which it appears lower
  double sight = 0;         ///< height of the line of sight there, metres above sea: curved upwards by `drop`
  bool visible = true;      ///< whether the eye sees the ground at this point
  bool after_hole = false;  ///< whether there are crossings next to nodata between the previous point and this one
};

/// Returns the points in order, ends included. A crossing at a node counts once. Throws as SightLine does.
std::vector<ProfilePoint> profile(const SightLine& line);

}  // namespace scarp
