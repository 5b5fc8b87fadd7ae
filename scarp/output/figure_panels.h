// SPDX-License-Identifier: MIT
// The parts of a figure that have their own rectangle: panels compute their size, and a page places them.
#pragma once

#include <functional>
#include <string>

#include "scarp/output/figure.h"
#include "scarp/output/figure_pen.h"

namespace scarp {

struct FigurePanel {
  std::string name{};  ///< for messages: "the legend"
  double width = 0, height = 0;
  /// Draws the panel with its upper left corner at (x, y). Refers to the arguments that the panel was made from.
  std::function<void(const FigurePen& pen, double x, double y)> draw{};
};

FigurePanel scale_panel(const FigurePen& pen, const FigureScale& scale);
/// `most_width`: maximum width of the colour bar.
FigurePanel legend_panel(const FigurePen& pen, const FigureLegend& legend, double most_width);
FigurePanel key_panel(const FigurePen& pen, const FigureKey& key);
/// The label of a strip.
FigurePanel strip_panel(const FigurePen& pen, const FigureStrip& strip);
FigurePanel arrow_panel(const FigurePen& pen, double north);
/// Lines are at most `most_width` long, unless a single word is longer. Throws Error if there would be more than three
/// lines.
FigurePanel title_panel(const FigurePen& pen, const std::string& title, double most_width);

}  // namespace scarp
