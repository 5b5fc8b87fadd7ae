// SPDX-License-Identifier: MIT
// Two pictures of the same view in one window, with a divider that can be dragged.
#pragma once

#include "scarp/base/vec.h"
#include "scarp/render/film/film.h"

namespace scarp::viewer {

/// Scales an image by nearest pixels.
Image stretched(const Image& image, int width, int height);

/// The left picture up to a column, and the right one from there on. Both have the same size.
Image split_image(const Image& left, const Image& right, int column);

/// The divider between two pictures, as a fraction of the window's width.
class SplitLine {
 public:
  double share() const { return share_; }
  /// The column of a picture of this width at which the right side starts, 0..width.
  int column(int width) const;
  /// Whether a position in a window of this size is on the divider.
  bool is_at(const dvec2& place, const dvec2& size) const;
  void drag_to(double x, double width);

 private:
  double share_ = 0.5;
};

}  // namespace scarp::viewer
