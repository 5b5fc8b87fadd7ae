// SPDX-License-Identifier: MIT
// Draws what marches do along one ray, over a profile of the ground: a panel for each march, one below the other, with
// the same axes. SVG, PDF or PNG. Requires a build with Cairo (SCARP_CAIRO).
//
//   bars    heights of the samples above the ground, and steps          naive, relaxed
//   shells  equal distances from the start of the ray                   fixed-step
//   balls   as wide as the steps, and the slope that they allow for     lipschitz
//   blocks  of the pyramid: passed, entered; cells: passed, tested      max-mip
#pragma once

#include <string>
#include <vector>

#include "scarp/base/march_trace.h"
#include "scarp/base/ray.h"
#include "scarp/base/replace_file.h"

namespace scarp {

/// The ground below the ray; a NaN height ends a stretch.
struct MarchFigurePoint {
  double distance = 0;  ///< metres
  double height = 0;    ///< metres
};

enum class MarchMarks : std::uint8_t { bars, shells, balls, blocks };

/// Whether balls are free of ground: by its steepest slope; by a slope that is steeper; or not proven.
enum class BallProof : std::uint8_t { steepest_slope, steeper_slope, none };

struct MarchPanel {
  std::string caption{};
  MarchMarks marks = MarchMarks::bars;
  BallProof proof = BallProof::steepest_slope;
  MarchTrace trace{};
  Hit hit{};
};

struct MarchFigure {
  std::vector<MarchFigurePoint> ground{};  ///< by distance
  /// The ray: its height at distance 0, and what one unit of t adds to its distance and to its height.
  double z = 0, distance_per_t = 1, rise_per_t = 0;
  double begin = 0;   ///< distance at which the figure begins
  double length = 0;  ///< distance at which the ray ends, > begin
  std::vector<MarchPanel> panels{};
  std::string title{};
  int width = 1200;
  int height = 0;  ///< pixels; 0: by the panels
};

/// Throws Error as write_plot() (plot.h) does, and naming `path` if the panels do not fit in the height.
void write_march_figure(ReplaceFile& file, const std::string& path, const MarchFigure& figure);

}  // namespace scarp
