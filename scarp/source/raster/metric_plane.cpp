// SPDX-License-Identifier: MIT
#include "scarp/source/raster/metric_plane.h"

#include <geodesic.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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
  Positions(const Georeference& geo, const OGRSpatialReference& crs) : map_(geo.map_from_node) {
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
    const auto& m = map_;
    double x = m[0] + col * m[1] + row * m[2], y = m[3] + col * m[4] + row * m[5];
    if (!transform_) return {x * degrees_per_unit_, y * degrees_per_unit_, true};
    const bool good = transform_->Transform(1, &x, &y) != 0;
    return {x, y, good && std::isfinite(x) && std::isfinite(y)};
  }
  // Metres east and north of `from`, by geodesic distance and azimuth.
  dvec2 metres(const LonLat& from, const LonLat& to) const {
    double distance = 0, azimuth = 0;
    geod_inverse(&geodesic_, from.lat, from.lon, to.lat, to.lon, &distance, &azimuth, nullptr);
    return {distance * std::sin(azimuth / kDegreesPerRadian), distance * std::cos(azimuth / kDegreesPerRadian)};
  }

 private:
  struct Deleter {
    void operator()(OGRCoordinateTransformation* t) const { OGRCoordinateTransformation::DestroyCT(t); }
  };
  std::array<double, 6> map_;
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
      const dvec2 ground = positions.metres(centre, place);
      const double right = c * plane.cell_x, up = -r * plane.cell_y;
      const double off_east = ground.x - (right * std::cos(turn) + up * std::sin(turn));
      const double off_north = ground.y - (up * std::cos(turn) - right * std::sin(turn));
      largest = std::max(largest, std::hypot(off_east, off_north) / std::min(plane.cell_x, plane.cell_y));
    }
  }
  return largest;
}

// Largest error on a line whose plane has its geodesic length.
double largest_error_along(const Positions& positions, const MetricPlane& plane, const dvec2& from, const dvec2& to) {
  const auto start = positions.at(from.x, from.y);
  const dvec2 end = positions.metres(start, positions.at(to.x, to.y));
  double largest = 0;
  for (const double share : {0.25, 0.5, 0.75}) {
    const dvec2 at = from + share * (to - from);
    const auto place = positions.at(at.x, at.y);
    if (place.good) largest = std::max(largest, length(positions.metres(start, place) - share * end));
  }
  return largest / std::min(plane.cell_x, plane.cell_y);
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

struct MetricPlanes::Ground {
  Ground(const Georeference& geo, const OGRSpatialReference& crs)
      : scales(ground_scales_of(geo.crs_wkt)), positions(geo, crs) {}

  std::shared_ptr<const GroundScales> scales;
  Positions positions;
};

MetricPlanes::MetricPlanes(const Georeference& georeference, int cols, int rows)
    : georeference_(georeference), cols_(cols), rows_(rows) {
  OGRSpatialReference crs;
  if (!read_crs(georeference, crs) || !(crs.IsGeographic() || crs.IsProjected())) return;
  ground_ = std::make_unique<Ground>(georeference, crs);
}

MetricPlanes::~MetricPlanes() = default;

MetricPlane MetricPlanes::local(const dvec2& at) const {
  const auto& m = georeference_.map_from_node;
  const GroundScale scale = ground_->scales->at(m[0] + at.x * m[1], m[3] + at.y * m[5]);
  return {scale.metres_per_x * m[1], scale.metres_per_y * -m[5], scale.grid_north_azimuth, 0};
}

MetricPlane MetricPlanes::around(const dvec2& at, double reach) const {
  if (!ground_) return {georeference_.cell_x_m, georeference_.cell_y_m, georeference_.grid_north_azimuth, 0};
  MetricPlane plane = local(at);
  if (reach > 0) plane.error_cells = largest_error(ground_->positions, plane, cols_, rows_, at.x, at.y, reach);
  return plane;
}

MetricPlane MetricPlanes::along(const dvec2& from, const dvec2& to) const {
  if (!ground_) return {georeference_.cell_x_m, georeference_.cell_y_m, georeference_.grid_north_azimuth, 0};
  MetricPlane plane = local(0.5 * (from + to));
  const double flat = length((to - from) * dvec2(plane.cell_x, plane.cell_y)), true_length = distance(from, to);
  if (!(flat > 0) || !(true_length > 0)) return plane;
  const double stretch = true_length / flat;
  plane.cell_x *= stretch;
  plane.cell_y *= stretch;
  plane.error_cells = largest_error_along(ground_->positions, plane, from, to);
  return plane;
}

double MetricPlanes::distance(const dvec2& from, const dvec2& to) const {
  if (!ground_) return length((to - from) * dvec2(georeference_.cell_x_m, georeference_.cell_y_m));
  const Positions& positions = ground_->positions;
  const auto start = positions.at(from.x, from.y), end = positions.at(to.x, to.y);
  return start.good && end.good ? length(positions.metres(start, end)) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace scarp
