// SPDX-License-Identifier: MIT
#include "app/cli/commands/cast_part.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

#include "app/cli/commands/cast_rays.h"
#include "scarp/source/raster/opened_raster.h"

namespace scarp::cli {
namespace {

// Smaller rasters are read whole, as for pictures.
constexpr double kLargestReadWhole = 64e6;  // samples

// The range of columns or rows that rays reach.
struct Reach {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  void add(double at) {
    low = std::min(low, at);
    high = std::max(high, at);
  }
  // First and last node, with two more cells on each side: touched lines belong to both of their cells, and positions
  // are rounded. Nothing if the rays pass beside the raster.
  std::optional<std::pair<int, int>> nodes(int side) const {
    constexpr double kBeside = 2;
    const double first = std::max(std::floor(low) - kBeside, 0.0),
                 last = std::min(std::ceil(high) + kBeside, side - 1.0);
    if (!(first < last)) return {};
    return std::pair(static_cast<int>(first), static_cast<int>(last));
  }
};

// A time after which a ray without an end is beside, above or below all samples of the raster.
double time_beyond(const Ray& ray, const Raster& header) {
  const Georeference& geo = header.georeference;
  const double east = (header.cols - 1) * geo.cell_x_m, north = (header.rows - 1) * geo.cell_y_m;
  const auto height = [&](double sample) { return sample * header.scale + header.offset; };
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  std::visit(
      [&]<class T>(const std::vector<T>&) {
        if constexpr (std::is_integral_v<T>)
          std::tie(low, high) =
              std::minmax({height(std::numeric_limits<T>::min()), height(std::numeric_limits<T>::max())});
      },
      header.samples);
  double end = std::numeric_limits<double>::infinity();
  const auto leave = [&](double at, double step, double first, double last) {
    if (step != 0) end = std::min(end, ((step > 0 ? last : first) - at) / step);
  };
  leave(ray.origin.x, ray.direction.x, 0, east);
  leave(ray.origin.y, ray.direction.y, 0, north);
  leave(ray.origin.z, ray.direction.z, low, high);
  // Vertical rays stay at their column and row.
  return ray.direction.x == 0 && ray.direction.y == 0 ? ray.t_min : std::max(end, ray.t_min);
}

bool depends_on_whole(const InputOptions& options) {
  return options.field.wrap != Wrap::none || options.field.mirror || options.exaggeration.chosen ||
         !options.device.empty() || !options.mesh.file.empty() ||
         !(options.march.empty() || options.march == kTerrainMarch);
}

}  // namespace

std::optional<CastPart> part_of_rays(const InputOptions& options, RayTable& table, const std::string& coordinates,
                                     bool skip_bad) {
  if (depends_on_whole(options) || table.rows.empty()) return {};
  const OpenedRaster file(options.inputs, options.raster);
  const Raster& header = file.header();
  if (static_cast<double>(header.cols) * header.rows <= kLargestReadWhole) return {};
  const Georeference& geo = header.georeference;
  CastPart found{{}, {header.path, geo, header.cols, header.rows}, {}};
  const Coordinates kind = !coordinates.empty() ? find_coordinates(coordinates)
                           : geo.present        ? Coordinates::map
                                                : Coordinates::local;
  const Places places(found.raster, kind, 1);
  Reach cols, rows;
  for (const Ray& ray : placed_rays(table, places.frame(), skip_bad)) {
    if (ray.start != RayStart::free) return {};
    for (const double t : {ray.t_min, std::isfinite(ray.t_max) ? ray.t_max : time_beyond(ray, header)}) {
      if (!std::isfinite(t)) return {};
      const dvec3 at = ray.at(t);
      cols.add(at.x / geo.cell_x_m);
      rows.add(header.rows - 1 - at.y / geo.cell_y_m);
    }
  }
  const auto across = cols.nodes(header.cols), down = rows.nodes(header.rows);
  if (!across || !down) return {};
  found.part = {across->first, down->first, across->second - across->first + 1, down->second - down->first + 1};
  found.origin = {across->first * geo.cell_x_m, (header.rows - 1 - down->second) * geo.cell_y_m, 0};
  return found;
}

}  // namespace scarp::cli
