// SPDX-License-Identifier: MIT
// Drawings over the picture: messages, the line between two pictures, the measured line.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "app/viewer/ground_answers.h"
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

/// A point of a line over the ground, in world metres, with the colour of the piece that ends there. A z of NaN
/// interrupts the line.
struct GroundPoint {
  dvec3 at{0.0};
  ImU32 colour = 0;
};
/// Draws a line over the ground, dim where the ground hides it, raised by `lift` metres. `camera` is that of the
/// picture of the layout.
void draw_on_ground(const std::vector<GroundPoint>& line, double lift, const Scene& scene, const Camera& camera,
                    const WindowLayout& layout);
/// Draws a round mark at a point in world metres.
void draw_mark(const dvec3& at, ImU32 colour, const Camera& camera, const WindowLayout& layout);

/// Draws a measured line over the ground, with its ends.
void draw_measured(const MeasuredLine& line, const Scene& scene, const Camera& camera, double exaggeration,
                   const WindowLayout& layout);

/// Draws a line of sight over the ground: what the observer sees of it in one colour, the rest in another.
void draw_sight(const SightAnswer& sight, const Scene& scene, const Camera& camera, const WindowLayout& layout);

}  // namespace scarp::viewer
