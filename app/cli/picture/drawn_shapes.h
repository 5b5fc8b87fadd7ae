// SPDX-License-Identifier: MIT
// Vectors of --draw on maps, and marks at places.
#pragma once

#include <string>
#include <vector>

#include "app/cli/options/draw_options.h"
#include "scarp/base/georeference.h"
#include "scarp/base/vec.h"
#include "scarp/output/figure.h"
#include "scarp/render/camera/camera.h"

namespace scarp::cli {

/// A raster on a map by a camera of Camera::top(): pixels of the picture are `per_pixel` per pixel of the camera.
struct DrawnMap {
  const Georeference& georeference;
  int cols, rows;
  const Camera& camera;
  double per_pixel;
};

/// Returns the points, lines and polygons of the files: longitude and latitude if the file has a CRS or such columns,
/// otherwise map coordinates, or local ones without a georeference. Throws Error naming the file: not readable, no such
/// column.
std::vector<FigureShape> drawn_shapes(const DrawOptions& options, const DrawnMap& map);

/// A place in columns and rows of the raster, with its name.
struct DrawnMark {
  dvec2 at{0.0};
  std::string name;
};

/// Returns marks as points. Names that repeat are written once.
std::vector<FigureShape> drawn_marks(const std::vector<DrawnMark>& marks, const DrawnMap& map);

}  // namespace scarp::cli
