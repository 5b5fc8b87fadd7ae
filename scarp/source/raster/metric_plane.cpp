// SPDX-License-Identifier: MIT
#include "scarp/source/raster/metric_plane.h"

#include <geodesic.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "scarp/base/error.h"
#include "scarp/source/raster/ground_scale.h"

namespace scarp {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;
constexpr double kEarthShare = 0.05;  // as in gdal_viewshed: other bodies have no refraction by default

bool read_crs(const Georeference& geo, OGRSpatialReference& crs) {
  if (geo.crs_wkt.empty() || crs.importFromWkt(geo.crs_wkt.c_str()) != OGRERR_NONE) return false;
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return true;
}

// Positions on the ellipsoid of a raster's CRS.
class Positions {
 public:
  Positions(const Georeference& geo, const OGRSpatialReference& crs) : geo_(geo) {
    geod_init(&geodesic_, crs.GetSemiMajor(), crs.GetInvFlattening() > 0 ? 1 / crs.GetInvFlattening() : 0);
    degrees_per_unit_ = crs.IsGeographic() ? crs.GetAngularUnits() * kDegreesPerRadian : 0;
    if (crs.IsGeographic()) return;
    const std::unique_ptr<OGRSpatialReference> base(crs.CloneGeogCS());
    if (!base) throw Error("the CRS has no geographic base");
    base->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    base->SetAngularUnits(SRS_UA_DEGREE, 1 / kDegreesPerRadian);
    transform_.reset(OGRCreateCoordinateTransformation(&crs, base.get()));
    if (!transform_) throw Error("the CRS cannot be transformed to longitude and latitude");
  }
  struct LonLat {
    double lon, lat;
    bool good;
  };
  LonLat at(double col, double row) const {
    const auto& m = geo_.map_from_node;
    double x = m[0] + col * m[1] + row * m[2], y = m[3] + col * m[4] + row * m[5];
    if (!transform_) return {x * degrees_per_unit_, y * degrees_per_unit_, true};
    const bool good = transform_->Transform(1, &x, &y) != 0;
    return {x, y, good && std::isfinite(x) && std::isfinite(y)};
  }
  // Metres east and north of `from`, by geodesic distance and azimuth.
  std::pair<double, double> metres(const LonLat& from, const LonLat& to) const {
    double distance = 0, azimuth = 0;
    geod_inverse(&geodesic_, from.lat, from.lon, to.lat, to.lon, &distance, &azimuth, nullptr);
    return {distance * std::sin(azimuth / kDegreesPerRadian), distance * std::cos(azimuth / kDegreesPerRadian)};
  }

 private:
  struct Deleter {
    void operator()(OGRCoordinateTransformation* t) const { OGRCoordinateTransformation::DestroyCT(t); }
  };
  const Georeference& geo_;
  geod_geodesic geodesic_{};
  double degrees_per_unit_ = 0;
  std::unique_ptr<OGRCoordinateTransformation, Deleter> transform_;
};

// Largest error on rings around the centre, clipped to the raster.
double largest_error(const Positions& positions, const MetricPlane& plane, int cols, int rows, double col, double row,
                     double reach) {
  const auto centre = positions.at(col, row);
  if (!centre.good) return 0;
  const double turn = plane.grid_north_azimuth;
  double largest = 0;
  constexpr int kDirections = 64;
  constexpr double kRings[] = {0.25, 0.5, 0.75, 1};
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections, x = std::cos(angle), y = std::sin(angle);
    // Columns and rows to the border or the reach, whichever comes first.
    const double to_col = x > 0 ? (cols - 1 - col) / x : x < 0 ? -col / x : HUGE_VAL;
    const double to_row = y > 0 ? (rows - 1 - row) / y : y < 0 ? -row / y : HUGE_VAL;
    const double to_reach = reach / std::hypot(x * plane.cell_x, y * plane.cell_y);
    const double cells = std::min({to_col, to_row, to_reach});
    for (const double ring : kRings) {
      const double c = x * cells * ring, r = y * cells * ring;
      const auto place = positions.at(col + c, row + r);
      if (!place.good) continue;
      const auto [east, north] = positions.metres(centre, place);
      const double right = c * plane.cell_x, up = -r * plane.cell_y;
      const double off_east = east - (right * std::cos(turn) + up * std::sin(turn));
      const double off_north = north - (up * std::cos(turn) - right * std::sin(turn));
      largest = std::max(largest, std::hypot(off_east, off_north) / std::min(plane.cell_x, plane.cell_y));
    }
  }
  return largest;
}

}  // namespace

Body body_of(const Georeference& georeference) {
  Body body;
  OGRSpatialReference crs;
  if (!read_crs(georeference, crs)) return body;
  OGRErr failed = OGRERR_NONE;
  const double axis = crs.GetSemiMajor(&failed);
  if (failed != OGRERR_NONE || !(axis > 0)) return body;
  body.earth = std::abs(axis / body.semi_major - 1) <= kEarthShare;
  body.semi_major = axis;
  return body;
}

bool is_geographic(const Georeference& georeference) {
  OGRSpatialReference crs;
  return read_crs(georeference, crs) && crs.IsGeographic();
}

MetricPlane metric_plane(const Georeference& geo, int cols, int rows, double col, double row, double reach) {
  MetricPlane plane{geo.cell_x_m, geo.cell_y_m, geo.grid_north_azimuth, 0};
  OGRSpatialReference crs;
  if (!read_crs(geo, crs) || !(crs.IsGeographic() || crs.IsProjected())) return plane;
  const auto& m = geo.map_from_node;
  const GroundScale scale = ground_scale_at(geo.crs_wkt, m[0] + col * m[1], m[3] + row * m[5]);
  plane.cell_x = scale.metres_per_x * m[1];
  plane.cell_y = scale.metres_per_y * -m[5];
  plane.grid_north_azimuth = scale.grid_north_azimuth;
  plane.error_cells = largest_error(Positions(geo, crs), plane, cols, rows, col, row, reach);
  return plane;
}

}  // namespace scarp
