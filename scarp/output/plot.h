// SPDX-License-Identifier: MIT
// Private to the station: a plot of heights over distances, and its file. Requires a build with Cairo (SCARP_CAIRO).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scarp/base/replace_file.h"
#include "scarp/output/figure_pen.h"

namespace scarp {

struct PlotColour {
  double r, g, b;
  double a = 1;
};

/// Colour of the ground below its surface, and of the lines of the axes.
inline constexpr PlotColour kPlotGround{0.80, 0.76, 0.69}, kPlotGrid{0.86, 0.86, 0.86};

/// A vertical line of the axes.
struct PlotTick {
  double at = 0;
  std::string number{};
  std::string name{};  ///< below the number
};

/// A rectangle of the picture with its range of distances and heights, in metres unless the axes have other names.
struct Plot {
  FigureRect box{};
  double begin = 0, end = 1;          ///< distances at its left and right side
  double low = 0, high = 1;           ///< heights at its lower and upper side
  std::vector<PlotTick> ticks{};      ///< empty: at round distances
  std::string along{};                ///< name of the horizontal axis with `ticks`
  std::string upward = "height (m)";  ///< name of the vertical axis

  double x(double distance) const { return box.x + box.width * (distance - begin) / (end - begin); }
  double y(double height) const { return box.y + box.height * (high - height) / (high - low); }

  /// Lines at round numbers or ticks with the numbers, and the names of the axes; `names_distance`: below as well.
  void axes(const FigurePen& pen, bool names_distance) const;
};

void set_colour(cairo_t* cr, const PlotColour& colour);

/// Writes SVG, PDF or PNG, depending on the extension of `path`, to the temporary file of `file`, and commits it.
/// `draw` draws on a white page of this size in pixels (PDF: points). Throws Error naming `path` if writing fails (disk
/// full), or for another extension.
void write_plot(ReplaceFile& file, const std::string& path, int width, int height,
                const std::function<void(cairo_t*)>& draw);

}  // namespace scarp
