// SPDX-License-Identifier: MIT
// Labels of strips.
#include <algorithm>

#include "scarp/output/figure_panels.h"

namespace scarp {

FigurePanel strip_panel(const FigurePen& measure, const FigureStrip& strip) {
  FigurePanel panel{strip.lines.empty() ? "a label" : "the label of " + strip.lines.front()};
  for (const std::string& line : strip.lines) panel.width = std::max(panel.width, measure.width_of(line));
  panel.height = static_cast<double>(strip.lines.size()) * measure.line_height();
  panel.draw = [lines = strip.lines, width = panel.width](const FigurePen& pen, double x, double y) {
    for (const std::string& line : lines) {
      pen.write(x + (width - pen.width_of(line)) / 2, y + pen.ascent(), line);
      y += pen.line_height();
    }
  };
  return panel;
}

}  // namespace scarp
