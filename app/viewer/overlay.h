// SPDX-License-Identifier: MIT
// Drawings over the picture: messages, the line between two pictures, the measured line.
#pragma once

#include <string>
#include <vector>

#include "app/viewer/layout.h"
#include "app/viewer/reading.h"
#include "scarp/render/camera/camera.h"
#include "scarp/scene/scene.h"

namespace scarp::viewer {

/// A message over the picture.
struct Toast {
  std::string text{};
  bool is_error = false;
  double until = 0;  ///< seconds since the window opened
};

/// Draws a message at the lower edge of the picture, errors in red.
void draw_toast(const Toast& toast, const WindowLayout& layout);

/// Draws the line between two pictures over a window of this size, and the names of its sides.
void draw_split(double x, const std::vector<std::string>& names);

/// Draws a measured line over the ground, dim where the ground hides it, with its ends. `camera` is that of the picture
/// of the layout.
void draw_measured(const MeasuredLine& line, const Scene& scene, const Camera& camera, double exaggeration,
                   const WindowLayout& layout);

}  // namespace scarp::viewer
