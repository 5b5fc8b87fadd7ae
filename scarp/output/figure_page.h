// SPDX-License-Identifier: MIT
// Places the parts of a figure, and draws them with the picture.
#pragma once

#include <cstddef>
#include <vector>

#include "scarp/output/figure_panels.h"
#include "scarp/output/figure_pen.h"

namespace scarp {

class FigurePage {
 public:
  /// Lays the figure out for a picture of this size, and keeps a reference to it. Throws Error if the picture is too
  /// small for it.
  FigurePage(const Figure& figure, int width, int height);

  /// Size in pixels: the picture's, plus margins if the layout has them.
  int width() const { return width_; }
  int height() const { return height_; }
  /// `cr`: in pixels, (0, 0) is the upper left corner of the page. `picture`: an image surface.
  void draw(cairo_t* cr, cairo_surface_t* picture) const;

 private:
  struct Placed {
    FigurePanel panel;
    FigureRect rect;  // including padding
  };

  void place_on(const FigurePen& pen, int width, int height);
  void place_beside(const FigurePen& pen, int width, int height);
  void place_strips(const FigurePen& pen, double top);
  void require_fit() const;
  void draw_dividers(const FigurePen& pen) const;
  void place(FigurePanel panel, double x, double y, double pad);

  const Figure& figure_;
  double text_, label_text_;
  int width_, height_;
  FigureRect frame_;  // the picture's position
  std::vector<Placed> placed_;
  std::size_t strips_ = 0;  // index of the first label of a strip in placed_, with margins
};

}  // namespace scarp
