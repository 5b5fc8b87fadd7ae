// SPDX-License-Identifier: MIT
// Readings under the cursor as text, from one ray in double precision; and the line of sight between two points.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/places.h"
#include "scarp/render/camera/camera.h"
#include "scarp/scene/scene.h"

namespace scarp::viewer {

/// The coordinates, in addition to metres, in which the window shows positions of georeferenced inputs.
struct ReadingFrames {
  explicit ReadingFrames(const cli::PlaceRaster& raster);
  std::unique_ptr<CoordinateFrame> map{}, lonlat{};  ///< null: not georeferenced
  std::string crs{};                                 ///< short name for display: "EPSG:32610"; empty: none
};

struct Reading {
  dvec3 point{0.0};  ///< world metres
  Ray ray{};
  Hit hit{};
  std::string place{};  ///< for other programs: "-84.23,36.48 (lon,lat on WGS 84); 692000,5143000 (EPSG:32610)"
  std::vector<std::string> lines{};  ///< "x 1203.4 m, y 880.1 m, height 512.3 m"
};

/// Traces the ray through (x, y) of the camera's picture. Returns nullopt if it hits nothing. `scene` is on the CPU.
/// Heights in the text are divided by `exaggeration`.
std::optional<Reading> read_under(const Scene& scene, const Camera& camera, const dvec2& at,
                                  const ReadingFrames& frames, double exaggeration);

/// Measures a line between two surface points: its length, slope, the profile of the ground below it, and whether its
/// ends see each other from `above` metres over the surface.
struct MeasuredLine {
  dvec3 from{0.0}, to{0.0};   ///< world metres
  double flat = 0, rise = 0;  ///< metres
  bool sees = false;
  std::vector<float> heights{};  ///< heights of the ground at equal distances, without exaggeration; NaN: no ground
};
MeasuredLine measure_line(const Scene& scene, const dvec3& from, const dvec3& to, double above, double exaggeration);

}  // namespace scarp::viewer
