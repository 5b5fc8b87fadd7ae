// SPDX-License-Identifier: MIT
#include "app/viewer/reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "scarp/base/error.h"
#include "scarp/scene/voxel_entry.h"
#include "scarp/source/raster/coordinates.h"

namespace scarp::viewer {
namespace {

constexpr int kProfile = 256;  // samples of a profile
constexpr double kDegree = std::numbers::pi / 180;

std::unique_ptr<CoordinateFrame> frame_of(const cli::PlaceRaster& raster, Coordinates coordinates) {
  try {
    return std::make_unique<CoordinateFrame>(raster.georeference, raster.cols, raster.rows, coordinates);
  } catch (const Error&) {
    return {};  // without a CRS, or one unknown to PROJ
  }
}

// "EPSG:32610" of "WGS 84 / UTM zone 10N (EPSG:32610)"; names without a code in full.
std::string short_name(const std::string& name) {
  const std::size_t open = name.rfind('(');
  return name.ends_with(')') && open != std::string::npos ? name.substr(open + 1, name.size() - open - 2) : name;
}

std::optional<dvec3> place_in(const std::unique_ptr<CoordinateFrame>& frame, const dvec3& point) {
  if (!frame) return {};
  std::array<dvec3, 1> points{point};
  if (frame->from_local(points)) return {};
  return points[0];
}

}  // namespace

ReadingFrames::ReadingFrames(const cli::PlaceRaster& raster) {
  if (!raster.georeference.present) return;
  map = frame_of(raster, Coordinates::map);
  lonlat = frame_of(raster, Coordinates::lonlat);
  crs = short_name(raster.georeference.crs_name);
}

std::optional<Reading> read_under(const Scene& scene, const Camera& camera, const dvec2& at,
                                  const ReadingFrames& frames, double exaggeration) {
  Reading reading;
  reading.ray = camera.ray(at.x, at.y);
  reading.hit = scene.closest_hit(reading.ray);
  if (!reading.hit || scene.field_of(reading.hit.object).is_backdrop()) return {};
  const SceneSurface surface = scene.surface(reading.ray, reading.hit);
  const dvec3& p = reading.point = surface.position;
  reading.lines.push_back(fmt::format("x {:.2f}  y {:.2f} m, height {:.2f} m", p.x, p.y, p.z / exaggeration));
  const auto map = place_in(frames.map, p), lonlat = place_in(frames.lonlat, p);
  if (map && map != lonlat)
    reading.lines.push_back(fmt::format("{} {:.2f}, {:.2f}", frames.crs.empty() ? "map" : frames.crs, map->x, map->y));
  if (lonlat) reading.lines.push_back(fmt::format("lon {:.6f}, lat {:.6f} degrees (WGS 84)", lonlat->x, lonlat->y));
  if (lonlat) reading.place = fmt::format("{:.7f},{:.7f} (lon,lat on WGS 84); ", lonlat->x, lonlat->y);
  if (map && map != lonlat)
    reading.place += fmt::format("{:.3f},{:.3f} ({}); ", map->x, map->y, frames.crs.empty() ? "map" : frames.crs);
  if (!lonlat && !map) reading.place = fmt::format("{:.3f},{:.3f} (local metres); ", p.x, p.y);
  reading.place += fmt::format("height {:.2f} m", p.z / exaggeration);
  if (const double size = length(surface.normal); size > 0) {
    const dvec3 flat(surface.normal.x / exaggeration, surface.normal.y / exaggeration, surface.normal.z);
    const double slope = std::atan2(std::hypot(flat.x, flat.y), std::abs(flat.z));
    reading.lines.push_back(fmt::format("slope {:.1f} degrees, distance {:.1f} m", slope / kDegree, reading.hit.t));
  }
  if (reading.hit.voxel.x >= 0) {
    const ivec3 v = file_voxel(scene, reading.hit).value_or(reading.hit.voxel);
    reading.lines.push_back(fmt::format("voxel {}, {}, {} of object {}", v.x, v.y, v.z, reading.hit.part));
    if (surface.colour) {
      const VoxelColour& c = *surface.colour;
      const std::optional<std::uint32_t> entry = palette_entry(scene, reading.hit);
      reading.lines.push_back(
          fmt::format("{} ({}, {}, {})", entry ? fmt::format("palette {}", *entry) : "colour", c[0], c[1], c[2]));
    }
  } else if (scene.terrain()) {
    reading.lines.push_back(fmt::format("cell {}, {}", reading.hit.cell.col, reading.hit.cell.row));
  }
  return reading;
}

MeasuredLine measure_line(const Scene& scene, const dvec3& from, const dvec3& to, double above, double exaggeration) {
  MeasuredLine line;
  line.from = from, line.to = to;
  line.flat = std::hypot(to.x - from.x, to.y - from.y);
  line.rise = (to.z - from.z) / exaggeration;
  const dvec3 lift(0, 0, above * exaggeration);
  Ray ray;
  ray.origin = from + lift;
  ray.direction = to - from;
  ray.t_max = 1;
  line.sees = !scene.occluded(ray);
  for (int i = 0; i < kProfile; ++i) {
    const double share = i / (kProfile - 1.0);
    const auto height = scene.height(from.x + share * (to.x - from.x), from.y + share * (to.y - from.y));
    line.heights.push_back(height ? static_cast<float>(*height / exaggeration) : NAN);
  }
  return line;
}

}  // namespace scarp::viewer
