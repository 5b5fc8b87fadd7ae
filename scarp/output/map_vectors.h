// SPDX-License-Identifier: MIT
// Writes maps as polygons, and heights as contour lines, in vector formats of GDAL. Requires a build with GDAL
// (SCARP_GDAL).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/output/raster_map.h"

namespace scarp {

/// Returns GDAL's name of the vector format for a file name (.gpkg, .geojson, .json, .shp, .fgb); empty for others.
std::string vector_driver_of(const std::string& path);

/// Writes the areas of equal pixels of bands of codes or counts, without nodata, as polygons whose borders are those of
/// pixels. The only layer has the fields `value`, `class` if there are classes, and `band` if there are several bands.
/// Pixels are joined across sides, not corners. GeoJSON is in longitude and latitude if the map has a CRS. Without a
/// place, coordinates count from the centre of the south-west pixel. The driver of the map is not used. Writes
/// completely or not at all. Throws Error naming the file.
void write_map_polygons(const std::string& path, const RasterMap& map, const Progress& progress = {});

/// The heights of contour lines: multiples of `interval` plus `base`, or `levels`.
struct ContourLevels {
  std::optional<double> interval{};  ///< above 0
  double base = 0;
  std::vector<double> levels{};
};

/// Writes contour lines of the first band, of floats, with its values at the centres of pixels and linear between them.
/// The only layer has the field `elev`. Otherwise like write_map_polygons().
void write_contours(const std::string& path, const RasterMap& map, const ContourLevels& levels,
                    const Progress& progress = {});

}  // namespace scarp
