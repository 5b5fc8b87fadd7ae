// SPDX-License-Identifier: MIT
// Draws the skyline of a point over the azimuth, with names of what is visible and with paths of the sun, as SVG, PDF
// or PNG. Requires a build with Cairo (SCARP_CAIRO).
//
//   elevation |      2 Hut                  layers   ground up to a distance, drawn from the farthest to the nearest:
//   each
//             |   1  |   /\  sun                     pixel has the colour of the nearest ground that hides the rest
//             |  /\__|__/  \.                labels   a dot at the place, a line upwards, and a name above the skyline
//             |_/             \__           paths    behind the ground
//              N    E    S    W    N  azimuth
#pragma once

#include <string>
#include <vector>

#include "scarp/base/replace_file.h"

namespace scarp {

/// A direction in degrees: azimuth clockwise from true north, elevation above the horizontal.
struct SkyPoint {
  double azimuth = 0, elevation = 0;
};

/// Ground up to a distance from the eye.
struct SkylineLayer {
  std::string name;               ///< for the legend
  std::vector<double> elevation;  ///< degrees, of each azimuth of the figure; -90: no ground
};

struct SkylineLabel {
  SkyPoint at;
  std::string name;
};

/// The sun on one day.
struct SunPath {
  std::string name;                 ///< for the legend
  std::vector<SkyPoint> points;     ///< in order of time
  std::vector<SkylineLabel> hours;  ///< dots on the path; a name may be empty
  bool main = false;                ///< drawn strongly
};

struct SkylineFigure {
  std::vector<double> azimuths;        ///< ascending, at least 2; the last is the first + 360
  std::vector<SkylineLayer> layers;    ///< the skyline first, then from far to near; at least 1
  std::vector<SkylineLabel> labels{};  ///< where names do not fit, the first wins
  std::vector<SunPath> paths{};
  std::vector<SkylineLabel> marks{};  ///< on the skyline, such as sunrise; drawn even if names overlap
  std::string title{};
  std::string remark{};            ///< below the title
  int width = 1200, height = 480;  ///< pixels
};

/// Writes the figure to the temporary file of `file`, and commits it. Returns the number of labels that were left out
/// for lack of room. Throws Error as write_plot() (plot.h) does.
int write_skyline_figure(ReplaceFile& file, const std::string& path, const SkylineFigure& figure);

}  // namespace scarp
