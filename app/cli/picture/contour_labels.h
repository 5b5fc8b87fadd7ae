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
  double interval = 0;  ///< between labelled lines: metres, not exaggerated, > 0
  double above =
      -std::numeric_limits<double>::infinity();  ///< no labels at and below this height: metres, not exaggerated
  double text = 10;                              ///< height of text, in pixels of the picture
  double per_pixel = 1;                          ///< pixels of the picture per pixel of the camera
};

/// Candidate labels for the contour lines of a map drawn by a camera of Camera::top(), those on the straightest pieces
/// first. Far more than fit; see Figure::labels.
std::vector<FigureLabel> contour_labels_of(const HeightField& field, const Camera& camera,
                                           const ContourLabelSettings& settings);

}  // namespace scarp::cli
