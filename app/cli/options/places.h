// SPDX-License-Identifier: MIT
// Positions of options and tables (--eye, --target, --mesh-at, --path, rays) in world metres.
//
//   local        metres as in the world: z includes the exaggeration
//   map, lonlat  by the raster's georeference (source/coordinates.h); z is in metres, as in the file
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "app/options/command.h"
#include "scarp/base/georeference.h"
#include "scarp/scene/scene.h"
#include "scarp/source/raster/coordinates.h"

namespace scarp::cli {

/// Declares --coords, the kind of coordinates of positions: `option` with its values and its inputs.
void add_coordinates_option(Command& command, std::string& coordinates, Option option);

/// X,Y or X,Y,Z of an option.
struct TypedPlace {
  double x = 0, y = 0;
  std::optional<double> z{};
  std::string text{};  ///< for messages

  bool operator==(const TypedPlace&) const = default;
};
/// Throws Error "OPTION 'TEXT': expected ...".
TypedPlace typed_place(const std::string& text, std::string_view option);

/// The raster that defines the conversion. Inputs without a georeference have only local coordinates.
struct PlaceRaster {
  std::string path{};  ///< for messages
  Georeference georeference{};
  int cols = 0, rows = 0;
};

class Places {
 public:
  /// `exaggeration` multiplies z of map and lonlat positions. Throws Error naming the file if the raster lacks the
  /// georeference or CRS that the coordinates require.
  Places(const PlaceRaster& raster, Coordinates coordinates, double exaggeration);

  const CoordinateFrame& frame() const { return frame_; }
  /// Returns a position in world metres. Throws Error beginning with `what` for a position outside the domain of the
  /// CRS.
  dvec3 world(const dvec3& given, std::string_view what) const;
  dvec3 world_direction(const dvec3& given) const;
  /// Returns the position of an option; without Z, on the surface. Throws Error as above and as on_surface().
  dvec3 world(const TypedPlace& given, const Scene& scene, std::string_view what) const;
  /// Returns `at`, a position in world metres, moved vertically to the surface (surface_at()). Throws Error naming the
  /// bounds of the scene if there is none.
  dvec3 on_surface(const dvec3& at, const Scene& scene, std::string_view what) const;

  /// "x 0 to 990, y 0 to 990" in the coordinates of the positions; empty for an endless scene.
  std::string bounds_text(const Scene& scene) const;

 private:
  CoordinateFrame frame_;
  double exaggeration_;
};

/// Returns z of the highest surface at (x, y), the hit of a vertical ray from above; nullopt if there is none. A plinth
/// does not count.
std::optional<double> surface_at(const Scene& scene, double x, double y);

/// Horizontal bounds of a scene: for a single raster, of its samples; otherwise of the box. z is 0 or that of the box.
WorldBox ground_box(const Scene& scene);

}  // namespace scarp::cli
