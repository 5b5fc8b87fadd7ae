// SPDX-License-Identifier: MIT
// Where the panel and the picture are in a window. In wide windows the panel has a column of its own and the picture
// fills the rest, so that nothing of it is hidden and its middle is that of the free part. In others the panel covers
// part of the picture.
#pragma once

#include "scarp/base/vec.h"

namespace scarp::viewer {

constexpr double kPanelWidth = 360;  ///< pixels at a scale of 1
constexpr float kMargin = 10;        ///< of the panel in small windows, and of drawings; pixels at a scale of 1

/// Pixels of a window; x to the right, y down.
struct WindowLayout {
  int left = 0;               ///< column at which the picture starts
  int width = 1, height = 1;  ///< of the picture
  bool beside = false;        ///< the panel is left of the picture, not over it
  double panel_width = kPanelWidth;

  /// A position in the window as one in the picture, which may be outside of it.
  dvec2 in_picture(const dvec2& at) const { return {at.x - left, at.y}; }
  bool contains(const dvec2& at) const { return at.x >= left && at.x < left + width && at.y >= 0 && at.y < height; }
};

/// `scale`: pixels per pixel at a scale of 1, > 0.
WindowLayout layout_of(int width, int height, bool panel, double scale);

}  // namespace scarp::viewer
