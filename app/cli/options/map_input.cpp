// SPDX-License-Identifier: MIT
#include "app/cli/options/map_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "app/cli/options/raster_options.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/scene/file/from_raster.h"

namespace scarp::cli {
namespace {

// The same samples with other cell lengths.
HeightField with_cells(const HeightField& field, double cell_x, double cell_y) {
  HeightFieldSettings settings = field.settings();
  settings.cell_x = cell_x;
  settings.cell_y = cell_y;
  return field.visit(
      [&](const auto& grid) { return HeightField::view(grid.data, grid.cols, grid.rows, settings, grid.row_stride); });
}

}  // namespace

void add_map_options(Command& command, MapOptions& options) {
  add_raster_inputs(command, options.inputs, "elevation model: anything GDAL reads, .npy, .npz, .exr");
  command.add(&options.plane_error, {.names = "--plane-error",
                                     .help = "maximum displacement of a sample on the metric plane",
                                     .unit = "cells",
                                     .range = kAboveZero});
  add_threads_option(command, options.threads);
  add_raster_options(command, options.raster);
}

void add_map_coordinates_option(Command& command, std::string& coordinates, std::vector<Rule> rules) {
  add_coordinates_option(command, coordinates,
                         {.names = "--coords",
                          .help = "coordinates of places",
                          .fallback = "map; local for inputs without a georeference",
                          .common = true,
                          .rules = std::move(rules)});
}

void add_curvature_option(Command& command, std::optional<double>& coefficient) {
  command.add(&coefficient, {.names = "--cc",
                             .help = "curvature coefficient, 1 - refraction coefficient",
                             .range = {0, 1},
                             .note = "0: flat; 1: curvature without refraction",
                             .fallback = "6/7 on Earth, 1 on other bodies",
                             .common = true});
}

void add_surface_option(Command& command, std::string& surface) {
  command.add(&surface, {.names = "--surface",
                         .value = "KIND",
                         .help = "surface between samples",
                         .choices = {"crossings", "bilinear"},
                         .closed = true,
                         .note = "crossings: linear on grid lines, nothing between them",
                         .common = true});
}

std::string_view surface_text(std::string_view surface) {
  return surface == "crossings" ? "linear at crossings of grid lines" : surface;
}

MapInput::MapInput(const MapOptions& options)
    : options_(options),
      file_(std::in_place, options.inputs, options.raster, terminal_progress("read")),
      header_(file_->header()),
      field_(HeightField::own(std::vector<float>{0}, 1, 1)) {
  stop_if_interrupted();
  const Georeference& geo = georeference();
  try {
    body_ = body_of(geo);
    geographic_ = is_geographic(geo);
    const Coordinates coordinates = !options.coordinates.empty() ? find_coordinates(options.coordinates)
                                    : geo.present                ? Coordinates::map
                                                                 : Coordinates::local;
    frame_.emplace(geo, cols(), rows(), coordinates);
    if (!geo.crs_wkt.empty()) lonlat_.emplace(geo, cols(), rows(), Coordinates::lonlat);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path(), error.what()));
  }
}

void MapInput::read(const RasterWindow& part, const Progress& progress) {
  const bool all = part == whole();
  Raster raster = all ? file_->read(progress) : file_->read(part, progress);
  stop_if_interrupted();
  for (const std::string& note : raster.notes) {
    const auto end = notes.begin() + static_cast<std::ptrdiff_t>(notes_of_file_);
    if (std::find(notes.begin(), end, note) != end) continue;
    notes.insert(end, note);
    ++notes_of_file_;
  }
  field_ = height_field_from(std::move(raster));
  part_ = part;
  if (all && field_.all_nodata())
    throw Error(fmt::format("{}: all {} x {} samples are nodata (choose another --window or --nodata)", path(), cols(),
                            rows()));
}

std::optional<double> MapInput::height_at_centre() {
  const HeightField one = height_field_from(file_->read({cols() / 2, rows() / 2, 1, 1}, {}));
  return one.all_nodata() ? std::nullopt : std::optional(one.min_height());
}

std::optional<double> MapInput::highest_possible() const {
  const auto height = [&](auto most) { return static_cast<double>(most) * header_.scale + header_.offset; };
  if (sample_type() == SampleType::int16) return height(std::numeric_limits<std::int16_t>::max());
  if (sample_type() == SampleType::uint16) return height(std::numeric_limits<std::uint16_t>::max());
  return {};
}

Georeference MapInput::georeference_of(const RasterWindow& part) const {
  Georeference geo = georeference();
  auto& map = geo.map_from_node;
  map[0] += part.col * map[1] + part.row * map[2];
  map[3] += part.col * map[4] + part.row * map[5];
  return geo;
}

SightCurvature MapInput::curvature() const {
  constexpr double kVisibleLight = 6.0 / 7;
  return {options_.curvature.value_or(body_.earth ? kVisibleLight : 1.0), 2 * body_.semi_major};
}

std::string MapInput::curvature_text() const {
  const SightCurvature used = curvature();
  return fmt::format("curvature coefficient {:.6g}, diameter {:.0f} m", used.coefficient, used.diameter);
}

Metadata MapInput::curvature_metadata() const {
  const SightCurvature used = curvature();
  return {{"CURVATURE_COEFFICIENT", fmt::format("{:.10g}", used.coefficient)},
          {"DIAMETER", fmt::format("{:.10g} m", used.diameter)}};
}

std::optional<dvec2> MapInput::find_position(const TablePlace& place, bool lonlat) const {
  std::array points{dvec3(place.x, place.y, 0)};
  if ((lonlat ? *lonlat_ : *frame_).to_local(points)) return std::nullopt;
  return dvec2(points[0].x / georeference().cell_x_m, rows() - 1 - points[0].y / georeference().cell_y_m);
}

bool MapInput::has_pixel(const dvec2& at) const {
  return at.x >= -0.5 && at.y >= -0.5 && at.x < cols() - 0.5 && at.y < rows() - 0.5;
}

std::string MapInput::swapped_hint(const TablePlace& place, bool lonlat) const {
  const auto at = find_position({place.y, place.x, {}}, lonlat);
  if (!at || !has_pixel(*at)) return {};
  const bool degrees = lonlat || frame_->coordinates() == Coordinates::lonlat ||
                       (is_geographic(georeference()) && frame_->coordinates() == Coordinates::map);
  return fmt::format("{:.10g},{:.10g} is inside: are {} swapped?", place.y, place.x,
                     degrees ? "longitude and latitude" : "x and y");
}

dvec2 MapInput::position_of(const TablePlace& place, bool lonlat, std::string_view what) const {
  if (lonlat && !lonlat_)
    throw Error(fmt::format("{}: {}: longitude and latitude need a raster with a CRS (--crs)", path(), what));
  if (const auto at = find_position(place, lonlat)) return *at;
  const std::string hint = swapped_hint(place, lonlat);
  throw Error(fmt::format("{}: ({}, {}) is outside the domain of the raster's CRS{}", what, place.x, place.y,
                          hint.empty() ? "" : fmt::format(" ({})", hint)));
}

dvec3 MapInput::direction_of(const dvec3& typed) const { return frame_->direction_to_local(typed); }

void MapInput::refuse_outside(const TablePlace& place, bool lonlat, std::string_view what) const {
  const std::string hint = swapped_hint(place, lonlat);
  const dvec2 low = place_of(-0.5, rows() - 0.5), high = place_of(cols() - 0.5, -0.5);
  throw Error(fmt::format("{}: {:.10g},{:.10g} is outside {}: x {:.10g} to {:.10g}, y {:.10g} to {:.10g} ({})", what,
                          place.x, place.y, path(), low.x, high.x, low.y, high.y, hint.empty() ? "--coords" : hint));
}

dvec2 MapInput::grid_of(const TablePlace& place, bool lonlat, std::string_view what) {
  const dvec2 at = position_of(place, lonlat, what);
  // Rounding may put places on the border outside.
  constexpr double kRounding = 0.5 / kSubcells;
  const dvec2 inside{std::clamp(at.x, 0.0, cols() - 1.0), std::clamp(at.y, 0.0, rows() - 1.0)};
  const double beyond = std::max(std::abs(at.x - inside.x), std::abs(at.y - inside.y));
  if (!(beyond <= 0.5 + kRounding)) refuse_outside(place, lonlat, what);
  if (beyond > kRounding && !std::exchange(border_is_noted_, true))
    notes.push_back(fmt::format(
        "{}: {:.10g},{:.10g} is in the outer half of a border pixel; such places are moved to the outermost samples",
        what, place.x, place.y));
  return inside;
}

Node MapInput::node_of(const TablePlace& place, bool lonlat, std::string_view what) const {
  const dvec2 at = position_of(place, lonlat, what);
  if (!has_pixel(at)) refuse_outside(place, lonlat, what);
  return {static_cast<int>(std::floor(at.x + 0.5)), static_cast<int>(std::floor(at.y + 0.5))};
}

dvec2 MapInput::place_of(double col, double row) const {
  std::array points{dvec3(col * georeference().cell_x_m, (rows() - 1 - row) * georeference().cell_y_m, 0)};
  frame_->from_local(points);
  return {points[0].x, points[0].y};
}

std::optional<dvec2> MapInput::lonlat_of(double col, double row) const {
  if (!lonlat_) return std::nullopt;
  std::array points{dvec3(col * georeference().cell_x_m, (rows() - 1 - row) * georeference().cell_y_m, 0)};
  if (lonlat_->from_local(points)) return std::nullopt;
  return dvec2(points[0].x, points[0].y);
}

const MetricPlane& MapInput::plane_at(double col, double row, double reach) {
  if (last_ && last_->col == col && last_->row == row && last_->reach >= reach) return last_->plane;
  last_ = Plane{col, row, reach, metric_plane(georeference(), cols(), rows(), col, row, reach)};
  const double error = last_->plane.error_cells;
  if (error > options_.plane_error) {
    const dvec2 at = lonlat_of(col, row).value_or(dvec2(0, 0));
    const int zone = std::clamp(static_cast<int>((at.x + 180) / 6) + 1, 1, 60);
    throw Error(
        fmt::format("{}: degrees: samples are up to {:.2g} cells off the metric plane, limit {} (first: gdalwarp "
                    "-t_srs EPSG:{}{:02} "
                    "-r bilinear {} utm.tif; or set a distance limit; or raise --plane-error)",
                    path(), error, options_.plane_error, at.y < 0 ? 327 : 326, zone, path()));
  }
  return last_->plane;
}

HeightField MapInput::field_at(double col, double row, double reach) {
  if (!geographic_) return field_;
  const MetricPlane& plane = plane_at(col, row, reach);
  if (!std::exchange(plane_is_noted_, true))
    notes.push_back(
        fmt::format("degrees: computed on a local metric plane, cells {:.6g} x {:.6g} m, samples up "
                    "to {:.2g} cells off",
                    plane.cell_x, plane.cell_y, plane.error_cells));
  return with_cells(field_, plane.cell_x, plane.cell_y);
}

std::optional<BilinearGround> MapInput::bilinear_ground(const HeightField& field) const {
  if (options_.surface != "bilinear") return std::nullopt;
  try {
    return BilinearGround(field);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path(), error.what()));
  }
}

dvec2 MapInput::cells_at(double col, double row, double reach) {
  if (!geographic_) return {georeference().cell_x_m, georeference().cell_y_m};
  const MetricPlane& plane = plane_at(col, row, reach);
  return {plane.cell_x, plane.cell_y};
}

double MapInput::grid_north_at(double col, double row, double reach) {
  return geographic_ ? plane_at(col, row, reach).grid_north_azimuth : georeference().grid_north_azimuth;
}

}  // namespace scarp::cli
