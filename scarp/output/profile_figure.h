// SPDX-License-Identifier: MIT
// Draws a terrain profile with a line of sight, as SVG, PDF or PNG. Requires a build with Cairo (SCARP_CAIRO).
#pragma once

#include <string>
#include <vector>

#include "scarp/base/replace_file.h"

namespace scarp {

/// One point along the profile.
struct ProfileFigurePoint {
  double distance = 0;      ///< metres
  double ground = 0;        ///< metres above sea level; NaN: a hole
  double sight = 0;         ///< height of the line of sight, metres above sea level
  bool visible = true;      ///< whether the observer sees the ground here
  bool after_hole = false;  ///< whether there is a hole between this point and the previous one
};

/// The first Fresnel zone at one point along the profile.
struct ProfileFigureZone {
  double distance = 0;       ///< metres
  double low = 0, high = 0;  ///< metres above sea level
};

struct ProfileFigure {
  std::vector<ProfileFigurePoint> points;  ///< at least 2, in order of distance
  std::vector<ProfileFigureZone> zone{};   ///< in order of distance; empty: none
  std::string title{};
  std::string remark{};  ///< below the title: method, curvature
  bool blocked = false;  ///< the line of sight is blocked at `block`
  ProfileFigurePoint block{};
  int width = 1200, height = 480;  ///< pixels
};

/// Writes SVG, PDF or PNG, depending on the extension of `path`, to the temporary file of `file`, and commits it.
/// Throws Error naming `path` if writing fails (disk full), or for another extension.
void write_profile_figure(ReplaceFile& file, const std::string& path, const ProfileFigure& figure);

}  // namespace scarp
