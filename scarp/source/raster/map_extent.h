// SPDX-License-Identifier: MIT
// Bounds of a raster on the map: of its samples, between which the surface extends, and of its pixels' outer edges.
#pragma once

#include <optional>

#include "scarp/base/georeference.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Bounds in units of the CRS and in degrees, WGS 84. A raster across 180 degrees of longitude has west > east, or an
/// east beyond 180 if its CRS is in degrees. Degrees are nullopt without a CRS, or if the CRS cannot be converted to
/// degrees.
struct MapExtent {
  MapBounds samples{};  ///< from the first sample to the last: the area that pictures show
  MapBounds edges{};    ///< half a cell farther on each side, as in --bounds
  std::optional<MapBounds> samples_lonlat{}, edges_lonlat{};
};

/// Returns the extent of a raster of `cols` x `rows` samples with a georeference. In degrees it is the smallest box of
/// longitudes and latitudes around the raster.
MapExtent map_extent(const Georeference& georeference, int cols, int rows);

}  // namespace scarp
