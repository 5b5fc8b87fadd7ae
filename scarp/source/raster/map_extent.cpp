// SPDX-License-Identifier: MIT
#include "scarp/source/raster/map_extent.h"

#include <ogr_spatialref.h>

#include <cmath>
#include <memory>

#include "scarp/source/gdal_errors.h"

namespace scarp {
namespace {

struct Destroy {
  void operator()(OGRCoordinateTransformation* transform) const { OGRCoordinateTransformation::DestroyCT(transform); }
};

// Bounds at 0 stay at 0: rounding moves them by far less than this fraction of a cell.
constexpr double kRounding = 1e-9;

double rounded(double bound, double cell) { return std::abs(bound) < kRounding * std::abs(cell) ? 0 : bound; }

std::optional<MapBounds> in_degrees(OGRCoordinateTransformation& transform, const MapBounds& map) {
  constexpr int kPointsPerSide = 21;  // GDAL's recommendation
  MapBounds degrees;
  if (!transform.TransformBounds(map.west, map.south, map.east, map.north, &degrees.west, &degrees.south, &degrees.east,
                                 &degrees.north, kPointsPerSide))
    return {};
  return degrees;
}

}  // namespace

MapExtent map_extent(const Georeference& georeference, int cols, int rows) {
  const auto& map = georeference.map_from_node;
  MapExtent extent;
  extent.samples = {map[0], map[3] + (rows - 1) * map[5], map[0] + (cols - 1) * map[1], map[3]};
  const MapBounds& s = extent.samples;
  extent.edges = {s.west - map[1] / 2, s.south + map[5] / 2, s.east + map[1] / 2, s.north - map[5] / 2};
  for (MapBounds* bounds : {&extent.samples, &extent.edges}) {
    for (double* x : {&bounds->west, &bounds->east}) *x = rounded(*x, map[1]);
    for (double* y : {&bounds->south, &bounds->north}) *y = rounded(*y, map[5]);
  }
  if (georeference.crs_wkt.empty()) return extent;
  const GdalSession session;  // silences errors about points that cannot be transformed
  OGRSpatialReference crs, lonlat;
  if (crs.importFromWkt(georeference.crs_wkt.c_str()) != OGRERR_NONE || lonlat.importFromEPSG(4326) != OGRERR_NONE)
    return extent;
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  lonlat.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation, Destroy> transform(
      OGRCreateCoordinateTransformation(&crs, &lonlat));
  if (!transform) return extent;
  extent.samples_lonlat = in_degrees(*transform, extent.samples);
  extent.edges_lonlat = in_degrees(*transform, extent.edges);
  return extent;
}

}  // namespace scarp
