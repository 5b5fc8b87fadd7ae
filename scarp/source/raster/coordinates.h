// SPDX-License-Identifier: MIT
// Converts between user coordinates and the metres of a field.
//
//   lonlat ──PROJ──▶ map ──georeference──▶ local: metres from the south-west sample, as in field/height_field.h
//
//            points x, y, z                         directions and normals
//   local    metres east and north (of the grid)    metres along the same axes
//   map      units of the raster's CRS, metres      directions: units of the CRS along x and y, metres along z, so that
//                                                   origin + t * direction is a point of the map; normals: as local
//   lonlat   degrees, WGS 84, longitude first;      metres east, north (true, as at the raster's centre) and up
//            metres
//
// z is the same in all of them: metres in the field, including its exaggeration. All arithmetic is in double: a round
// trip changes coordinates only by their rounding, far below 1e-9 of a cell.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "scarp/base/georeference.h"
#include "scarp/base/ray.h"
#include "scarp/base/vec.h"
#include "scarp/source/table/ray_table.h"

class OGRCoordinateTransformation;

namespace scarp {

enum class Coordinates : std::uint8_t { local, map, lonlat };

/// Returns "local", "map" or "lonlat".
std::string_view name_of(Coordinates coordinates);
/// Throws Error listing the names if `name` is unknown.
Coordinates find_coordinates(std::string_view name);

/// Conversions between local coordinates and one other kind, for one raster. Not thread-safe, because PROJ's
/// transformations are not.
class CoordinateFrame {
 public:
  /// For a raster of `cols` x `rows` samples. Throws Error without the file's name: a raster without the georeference
  /// or CRS that the coordinates require, a CRS that PROJ cannot transform to WGS 84.
  CoordinateFrame(const Georeference& georeference, int cols, int rows, Coordinates coordinates);
  ~CoordinateFrame();
  CoordinateFrame(CoordinateFrame&&) noexcept;

  Coordinates coordinates() const { return coordinates_; }

  /// Converts points in place. Returns the index of the first point without a counterpart: a longitude beyond +-360
  /// degrees, a latitude beyond +-90 degrees, a position outside the projection's domain. The points are then
  /// undefined.
  std::optional<std::size_t> to_local(std::span<dvec3> points) const;
  std::optional<std::size_t> from_local(std::span<dvec3> points) const;

  /// Converts a direction; the result is the same at any position.
  dvec3 direction_to_local(const dvec3& direction) const;
  /// Converts the unit normal of a surface; the result is the same at any position.
  dvec3 normal_from_local(const dvec3& normal) const;

 private:
  struct TransformDeleter {
    void operator()(OGRCoordinateTransformation* transform) const;
  };
  using Transform = std::unique_ptr<OGRCoordinateTransformation, TransformDeleter>;

  Georeference georeference_;
  Coordinates coordinates_;
  double last_row_;  // the southernmost one
  double centre_x_;  // centre of the raster, in map units
  double turn_ = 0;  // full circle in map units of a geographic CRS; 0: not geographic
  Transform map_from_lonlat_, lonlat_from_map_;
};

/// Returns the rays of a table in local metres. A target becomes the direction from origin to target. Throws Error
/// naming file, line and ray for a point without a counterpart.
std::vector<Ray> rays_in_local(const RayTable& table, const CoordinateFrame& frame);

}  // namespace scarp
