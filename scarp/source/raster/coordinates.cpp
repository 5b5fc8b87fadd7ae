// SPDX-License-Identifier: MIT
#include "scarp/source/raster/coordinates.h"

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scarp/base/error.h"
#include "scarp/source/gdal_errors.h"

namespace scarp {
namespace {

constexpr std::array<std::string_view, 3> kNames = {"local", "map", "lonlat"};

// Number of points per PROJ call: some kilobytes of coordinates.
constexpr std::size_t kBatch = 1024;

std::optional<std::size_t> apply(OGRCoordinateTransformation& transform, std::span<dvec3> points) {
  const GdalSession session;
  std::array<double, kBatch> x, y;
  std::array<int, kBatch> good;
  for (std::size_t begin = 0; begin < points.size(); begin += kBatch) {
    const std::span<dvec3> batch = points.subspan(begin, std::min(kBatch, points.size() - begin));
    for (std::size_t i = 0; i < batch.size(); ++i) {
      x[i] = batch[i].x;
      y[i] = batch[i].y;
    }
    transform.Transform(static_cast<int>(batch.size()), x.data(), y.data(), nullptr, good.data());
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (!good[i] || !std::isfinite(x[i]) || !std::isfinite(y[i])) return begin + i;
      batch[i].x = x[i];
      batch[i].y = y[i];
    }
  }
  return {};
}

}  // namespace

std::string_view name_of(Coordinates coordinates) { return kNames[static_cast<std::size_t>(coordinates)]; }

Coordinates find_coordinates(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) throw Error(fmt::format("unknown coordinates '{}' (expected local, map or lonlat)", name));
  return static_cast<Coordinates>(found - kNames.begin());
}

void CoordinateFrame::TransformDeleter::operator()(OGRCoordinateTransformation* transform) const {
  OGRCoordinateTransformation::DestroyCT(transform);
}

CoordinateFrame::CoordinateFrame(const Georeference& georeference, int cols, int rows, Coordinates coordinates)
    : georeference_(georeference),
      coordinates_(coordinates),
      last_row_(rows - 1),
      centre_x_(georeference.map_from_node[0] + (cols - 1) / 2.0 * georeference.map_from_node[1]) {
  if (coordinates == Coordinates::local) return;
  if (!georeference.present) {
    throw Error(
        fmt::format("no georeference, which {} coordinates require (add --bounds W,S,E,N, or use local coordinates)",
                    name_of(coordinates)));
  }
  if (coordinates == Coordinates::map && georeference.crs_wkt.empty()) return;
  if (georeference.crs_wkt.empty()) {
    throw Error(
        "no coordinate reference system, which lonlat coordinates require (specify one, or use map coordinates)");
  }
  GdalSession session;
  OGRSpatialReference map, lonlat;
  if (map.importFromWkt(georeference.crs_wkt.c_str()) != OGRERR_NONE || lonlat.importFromEPSG(4326) != OGRERR_NONE) {
    throw Error(fmt::format("unusable coordinate reference system '{}': {}", georeference.crs_name,
                            session.reason("GDAL gives no reason")));
  }
  if (map.IsGeographic()) turn_ = 2 * std::numbers::pi / map.GetAngularUnits();
  if (coordinates == Coordinates::map) return;
  map.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  lonlat.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  map_from_lonlat_.reset(OGRCreateCoordinateTransformation(&lonlat, &map));
  lonlat_from_map_.reset(OGRCreateCoordinateTransformation(&map, &lonlat));
  if (!map_from_lonlat_ || !lonlat_from_map_) {
    throw Error(fmt::format("PROJ cannot convert between WGS 84 and the coordinate reference system '{}': {}",
                            georeference.crs_name, session.reason("GDAL gives no reason")));
  }
}

CoordinateFrame::~CoordinateFrame() = default;
CoordinateFrame::CoordinateFrame(CoordinateFrame&&) noexcept = default;

std::optional<std::size_t> CoordinateFrame::to_local(std::span<dvec3> points) const {
  if (coordinates_ == Coordinates::local) return {};
  if (coordinates_ == Coordinates::lonlat) {
    // PROJ would wrap any number into the range of degrees, even metres passed by mistake.
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!(std::abs(points[i].x) <= 360 && std::abs(points[i].y) <= 90)) return i;
    }
    if (const auto failed = apply(*map_from_lonlat_, points)) return failed;
  }
  const Georeference& geo = georeference_;
  const auto& map = geo.map_from_node;
  for (dvec3& p : points) {
    // A place has many equivalent longitudes: choose the one nearest to the raster.
    if (turn_ > 0 && std::abs(p.x) <= turn_) p.x += turn_ * std::round((centre_x_ - p.x) / turn_);
    p.x = (p.x - map[0]) / map[1] * geo.cell_x_m;
    p.y = (last_row_ - (p.y - map[3]) / map[5]) * geo.cell_y_m;
  }
  return {};
}

std::optional<std::size_t> CoordinateFrame::from_local(std::span<dvec3> points) const {
  if (coordinates_ == Coordinates::local) return {};
  const Georeference& geo = georeference_;
  const auto& map = geo.map_from_node;
  for (dvec3& p : points) {
    p.x = map[0] + p.x / geo.cell_x_m * map[1];
    p.y = map[3] + (last_row_ - p.y / geo.cell_y_m) * map[5];
  }
  if (coordinates_ == Coordinates::map) return {};
  if (const auto failed = apply(*lonlat_from_map_, points)) return failed;
  for (dvec3& p : points) p.x -= 360 * std::round(p.x / 360);
  return {};
}

dvec3 CoordinateFrame::direction_to_local(const dvec3& d) const {
  const Georeference& geo = georeference_;
  switch (coordinates_) {
    case Coordinates::map:
      return {d.x / geo.map_from_node[1] * geo.cell_x_m, -d.y / geo.map_from_node[5] * geo.cell_y_m, d.z};
    case Coordinates::lonlat: {
      const double sin_north = std::sin(geo.grid_north_azimuth), cos_north = std::cos(geo.grid_north_azimuth);
      return {d.x * cos_north - d.y * sin_north, d.x * sin_north + d.y * cos_north, d.z};
    }
    case Coordinates::local:
      break;
  }
  return d;
}

dvec3 CoordinateFrame::normal_from_local(const dvec3& n) const {
  if (coordinates_ != Coordinates::lonlat) return n;
  const double sin_north = std::sin(georeference_.grid_north_azimuth),
               cos_north = std::cos(georeference_.grid_north_azimuth);
  return {n.x * cos_north + n.y * sin_north, n.y * cos_north - n.x * sin_north, n.z};
}

std::vector<Ray> rays_in_local(const RayTable& table, const CoordinateFrame& frame) {
  std::vector<dvec3> points;
  const auto to_local = [&](dvec3 RayRow::*member) {
    points.clear();
    for (const RayRow& row : table.rows) points.push_back(row.*member);
    if (const auto failed = frame.to_local(points)) {
      const dvec3 given = table.rows[*failed].*member;
      throw Error(
          fmt::format("{}: ({}, {}) is outside the domain of the raster's CRS (x is the longitude and y the "
                      "latitude, in degrees)",
                      table.where(*failed), given.x, given.y));
    }
  };
  std::vector<Ray> rays(table.rows.size());
  to_local(&RayRow::origin);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RayRow& row = table.rows[i];
    rays[i] = {.origin = points[i],
               .direction = {},
               .t_min = row.t_min,
               .t_max = row.t_max,
               .start = row.start,
               .start_cell = row.start_cell};
  }
  if (table.aim == RayAim::target) to_local(&RayRow::aim);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].direction =
        table.aim == RayAim::target ? points[i] - rays[i].origin : frame.direction_to_local(table.rows[i].aim);
  }
  return rays;
}

}  // namespace scarp
