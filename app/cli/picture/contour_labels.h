// SPDX-License-Identifier: MIT
// Heights written along the contour lines of a map.
#pragma once

#include <limits>
#include <vector>

#include "scarp/field/height_field.h"
#include "scarp/output/figure.h"
#include "scarp/render/camera/camera.h"

namespace scarp::cli {

struct ContourLabelSettings {
  double interval = 0;  ///< from one labelled line to the next: metres, not exaggerated, > 0
  double above = -std::numeric_limits<double>::infinity();  ///< no labels at and below this height, likewise
  double text = 10;                                         ///< height of text, in pixels of the picture
  double per_pixel = 1;                                     ///< pixels of the picture per pixel of the camera
};

/// Labels for the contour lines of a map by a camera of Camera::top(), those on the straightest pieces first. Far more
/// than there is room for: Figure::labels.
std::vector<FigureLabel> contour_labels_of(const HeightField& field, const Camera& camera,
                                           const ContourLabelSettings& settings);

}  // namespace scarp::cli
