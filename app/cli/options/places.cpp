// SPDX-License-Identifier: MIT
#include "app/cli/options/places.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "app/options/numbers.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

CoordinateFrame frame_of(const PlaceRaster& raster, Coordinates coordinates) {
  try {
    return {raster.georeference, raster.cols, raster.rows, coordinates};
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", raster.path, error.what()));
  }
}

}  // namespace

void add_coordinates_option(Command& command, std::string& coordinates, Option option) {
  option.value = "KIND";
  option.closed = true;
  for (const Coordinates kind : {Coordinates::local, Coordinates::map, Coordinates::lonlat})
    option.choices.emplace_back(name_of(kind));
  option.rules.push_back({"map or lonlat applies to terrain only (other inputs have no georeference)",
                          [&coordinates] { return coordinates == name_of(Coordinates::local); },
                          kEveryInput & ~kTerrain});
  command.add(&coordinates, std::move(option));
}

TypedPlace typed_place(const std::string& text, std::string_view option) {
  const auto numbers = numbers_from(text, ',', 2, 3, option, "X,Y or X,Y,Z, for example 500,300 or 500,300,1200");
  return {numbers[0], numbers[1], numbers.size() > 2 ? std::optional(numbers[2]) : std::nullopt, text};
}

Places::Places(const PlaceRaster& raster, Coordinates coordinates, double exaggeration)
    : frame_(frame_of(raster, coordinates)), exaggeration_(coordinates == Coordinates::local ? 1 : exaggeration) {}

dvec3 Places::world(const dvec3& given, std::string_view what) const {
  std::array points{given};
  if (frame_.to_local(points)) {
    throw Error(
        fmt::format("{}: ({}, {}) is outside the domain of the raster's CRS (x is the longitude and y the latitude, in "
                    "degrees)",
                    what, given.x, given.y));
  }
  points[0].z *= exaggeration_;
  return points[0];
}

dvec3 Places::world_direction(const dvec3& given) const {
  const dvec3 direction = frame_.direction_to_local(given);
  return {direction.x, direction.y, direction.z * exaggeration_};
}

dvec3 Places::world(const TypedPlace& given, const Scene& scene, std::string_view what) const {
  const dvec3 at = world(dvec3(given.x, given.y, given.z.value_or(0.0)), what);
  return given.z ? at : on_surface(at, scene, what);
}

dvec3 Places::on_surface(const dvec3& at, const Scene& scene, std::string_view what) const {
  if (const auto z = surface_at(scene, at.x, at.y)) return {at.x, at.y, *z};
  std::array shown{at};
  frame_.from_local(shown);
  const WorldBox box = ground_box(scene);
  const bool inside = at.x >= box.low.x && at.x <= box.high.x && at.y >= box.low.y && at.y <= box.high.y;
  const std::string bounds = bounds_text(scene);
  throw Error(fmt::format(
      "{}: there is no ground at {:.10g},{:.10g}{} (give Z, or another place)", what, shown[0].x, shown[0].y,
      bounds.empty() ? ""
                     : fmt::format(", {} the bounds in {} coordinates: {}", inside ? "a hole within" : "outside",
                                   name_of(frame_.coordinates()), bounds)));
}

std::string Places::bounds_text(const Scene& scene) const {
  const WorldBox box = ground_box(scene);
  std::array corners{box.low, box.high};
  if (scene.endless() || box.empty() || frame_.from_local(corners)) return {};
  return fmt::format("x {:.8g} to {:.8g}, y {:.8g} to {:.8g}", corners[0].x, corners[1].x, corners[0].y, corners[1].y);
}

std::optional<double> surface_at(const Scene& scene, double x, double y) {
  std::optional<double> highest = scene.height(x, y);
  // A height field has no surface in its holes, but a ray would hit the plinth there.
  if (scene.only_heights() || scene.box().empty()) return highest;
  const double top = std::max(scene.box().high.z, highest.value_or(scene.box().high.z)) + 1,
               bottom = std::min(scene.box().low.z, highest.value_or(scene.box().low.z)) - 1;
  const Ray down{{x, y, top}, {0, 0, -1}, 0, top - bottom};
  const Hit hit = scene.closest_hit(down);
  if (!hit || scene.field_of(hit.object).is_backdrop()) return highest;
  const double z = down.at(hit.t).z;
  return highest ? std::max(*highest, z) : z;
}

WorldBox ground_box(const Scene& scene) {
  const HeightField* field = scene.only_heights();
  return field ? WorldBox{dvec3(0.0), dvec3(field->width(), field->depth(), 0.0)} : scene.box();
}

}  // namespace scarp::cli
