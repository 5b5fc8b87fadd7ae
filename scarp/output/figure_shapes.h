// SPDX-License-Identifier: MIT
// Points, lines and areas of a figure, with their labels.
#pragma once

#include <vector>

#include "scarp/output/figure_pen.h"

namespace scarp {

/// Draws Figure::shapes into the picture at `frame`: areas, lines, then points. Adds the points to `taken`.
void draw_shapes(const FigurePen& pen, const Figure& figure, const FigureRect& frame, std::vector<FigureRect>& taken);

/// Writes the labels of the shapes, which must not touch `taken`, and adds them: beside points, in the middle of lines,
/// and in areas.
void draw_shape_labels(const FigurePen& pen, const Figure& figure, const FigureRect& frame,
                       std::vector<FigureRect>& taken);

}  // namespace scarp
