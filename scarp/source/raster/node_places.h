// SPDX-License-Identifier: MIT
// Longitudes and latitudes of the nodes of a raster, row by row, from many threads at once.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "scarp/source/raster/coordinates.h"

namespace scarp {

class NodePlaces {
 public:
  /// Throws Error without the file's name, as CoordinateFrame does for a raster without a CRS.
  NodePlaces(const Georeference& georeference, int cols, int rows);
  ~NodePlaces();

  /// Sets x and y to the longitudes and latitudes, in degrees (WGS 84), of the nodes (first_col + i, row), which may
  /// lie outside the raster. Throws Error for nodes outside the projection's domain.
  void row(int row, int first_col, std::span<dvec3> places) const;

 private:
  class Borrowed;

  Georeference georeference_;
  int cols_, rows_;
  // PROJ's transformations can be used by only one thread at a time.
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<CoordinateFrame>> free_;
};

}  // namespace scarp
