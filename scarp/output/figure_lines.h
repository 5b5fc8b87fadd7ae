// SPDX-License-Identifier: MIT
// The parts of a figure drawn into the picture itself: graticule and labels of contour lines.
#pragma once

#include <vector>

#include "scarp/output/figure.h"
#include "scarp/output/figure_pen.h"

namespace scarp {

/// Room that the graticule's labels need outside a picture of this size, in the layout `beside`.
struct FigureMargins {
  double left = 0, top = 0, right = 0;
};
FigureMargins graticule_margins(const FigurePen& pen, const std::vector<FigureLine>& graticule, double width,
                                double height);

/// Draws the graticule into the picture in `frame`. `taken` holds the occupied areas; the function adds to it.
void draw_graticule(const FigurePen& pen, const Figure& figure, const FigureRect& frame,
                    std::vector<FigureRect>& taken);
/// Draws labels; the text height of `pen` is figure_label_height().
void draw_labels(const FigurePen& pen, const Figure& figure, const FigureRect& frame, std::vector<FigureRect>& taken);

}  // namespace scarp
