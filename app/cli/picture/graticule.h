// SPDX-License-Identifier: MIT
// Meridians and parallels of a map.
#pragma once

#include <optional>
#include <vector>

#include "scarp/base/georeference.h"
#include "scarp/output/figure.h"
#include "scarp/render/camera/camera.h"

namespace scarp::cli {

/// Lines of round longitudes and latitudes (WGS 84) over a map by a camera of Camera::top(), `spacing_deg` apart;
/// nullopt: chosen for about five lines. `per_pixel`: pixels of the picture per pixel of the camera. Throws Error
/// without a georeference or CRS, and if no line, or more than 200, would cross the map.
std::vector<FigureLine> graticule_of(const Georeference& georeference, int cols, int rows, const Camera& camera,
                                     double per_pixel, std::optional<double> spacing_deg);

}  // namespace scarp::cli
