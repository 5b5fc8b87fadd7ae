// SPDX-License-Identifier: MIT
// Between the coordinates that people have and the metres of a field.
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
// z is the same everywhere: metres as the field has them, which is exaggerated heights where it exaggerates. All in
// double: there and back differs by the rounding of the coordinates themselves, far below 1e-9 of a cell.
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
#include "scarp/source/ray_table.h"

class OGRCoordinateTransformation;

namespace scarp {

enum class Coordinates : std::uint8_t { local, map, lonlat };

/// "local", "map" or "lonlat".
std::string_view name_of(Coordinates coordinates);
/// Throws Error listing the names when there are no such coordinates.
Coordinates find_coordinates(std::string_view name);

/// Not for several threads at once: PROJ's transformations are not.
class CoordinateFrame {
 public:
  /// Of a raster of `cols` x `rows` samples. Throws Error (without the file's name): a raster without georeference or
  /// CRS where the coordinates need one, a CRS from which PROJ knows no way to WGS 84.
  CoordinateFrame(const Georeference& georeference, int cols, int rows, Coordinates coordinates);
  ~CoordinateFrame();
  CoordinateFrame(CoordinateFrame&&) noexcept;

  Coordinates coordinates() const { return coordinates_; }

  /// Points, in place. Returns the index of the first one that has no counterpart: a longitude beyond +-360 or latitude
  /// beyond +-90 degrees, a place outside of what the projection can show. Then the points are of no use.
  std::optional<std::size_t> to_local(std::span<dvec3> points) const;
  std::optional<std::size_t> from_local(std::span<dvec3> points) const;

  /// A direction, at any place.
  dvec3 direction_to_local(const dvec3& direction) const;
  /// The unit normal of a surface, at any place.
  dvec3 normal_from_local(const dvec3& normal) const;

 private:
  struct TransformDeleter {
    void operator()(OGRCoordinateTransformation* transform) const;
  };
  using Transform = std::unique_ptr<OGRCoordinateTransformation, TransformDeleter>;

  Georeference georeference_;
  Coordinates coordinates_;
  double last_row_;  // the southern one
  double centre_x_;  // of the raster, in map units
  double turn_ = 0;  // full circle in map units of a geographic CRS; 0: it is not geographic
  Transform map_from_lonlat_, lonlat_from_map_;
};

/// The rays of a table in local metres. Targets become the direction from origin to target. Throws Error naming file,
/// line and ray: a point that has no counterpart.
std::vector<Ray> rays_in_local(const RayTable& table, const CoordinateFrame& frame);

}  // namespace scarp
