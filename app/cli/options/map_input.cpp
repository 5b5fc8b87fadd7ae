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
#include "app/options/numbers.h"
#include "scarp/base/ellipsoid.h"
#include "scarp/base/error.h"
#include "scarp/scene/file/from_raster.h"
#include "scarp/source/raster/warp_words.h"

namespace scarp::cli {
namespace {

// Grid north is a difference over this length on the ground, as in source/raster/ground_scale.h.
constexpr double kNorthStep_m = 1000;

// A number or a fraction.
double k_factor_from(const std::string& text) {
  constexpr std::string_view kForm = "a number or a fraction of at least 0.1, for example 4/3";
  const auto n = numbers_from(text, '/', 1, 2, "--k-factor", kForm);
  const double factor = n.size() > 1 ? n[0] / n[1] : n[0];
  if (!(factor >= 0.1 && std::isfinite(factor))) throw Error(fmt::format("--k-factor '{}': expected {}", text, kForm));
  return factor;
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
  command.add([&coefficient](const std::string& text) { coefficient = 1 / k_factor_from(text); },
              {.names = "--k-factor",
               .value = "K",
               .help = "effective Earth radius over the true one: --cc is 1/K",
               .note = "4/3: radio in a standard atmosphere",
               .fallback = "that of --cc",
               .excludes = {"--cc"}});
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

HeightField with_cells(const HeightField& field, const dvec2& cells) {
  HeightFieldSettings settings = field.settings();
  settings.cell_x = cells.x;
  settings.cell_y = cells.y;
  return field.visit(
      [&](const auto& grid) { return HeightField::view(grid.data, grid.cols, grid.rows, settings, grid.row_stride); });
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
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path(), error.what()));
  }
}

const CoordinateFrame* MapInput::find_lonlat() const {
  std::call_once(lonlat_is_sought_, [&] {
    if (georeference().crs_wkt.empty()) return;
    try {
      lonlat_.emplace(georeference(), cols(), rows(), Coordinates::lonlat);
    } catch (const Error& error) {
      no_lonlat_ = error.what();  // local systems and other bodies need none, unless places do
    }
  });
  return lonlat_ ? &*lonlat_ : nullptr;
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

std::string MapInput::warp_words() const {
  return warp_nodata_words(header_.file_type, header_.nodata.has_value(), options_.raster.nodata);
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
  if ((lonlat ? *find_lonlat() : *frame_).to_local(points)) return std::nullopt;
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
  if (lonlat && !find_lonlat())
    throw Error(
        fmt::format("{}: {}: {}", path(), what,
                    no_lonlat_.empty() ? "longitude and latitude need a raster with a CRS (--crs)" : no_lonlat_));
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
                          place.x, place.y, path(), low.x, high.x, low.y, high.y,
                          hint.empty() ? "--coords; to stand beyond the border, widen it: gdalbuildvrt -te" : hint));
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
  const CoordinateFrame* const lonlat = find_lonlat();
  if (!lonlat) return std::nullopt;
  std::array points{dvec3(col * georeference().cell_x_m, (rows() - 1 - row) * georeference().cell_y_m, 0)};
  if (lonlat->from_local(points)) return std::nullopt;
  return dvec2(points[0].x, points[0].y);
}

const MetricPlanes& MapInput::planes() {
  if (!planes_) planes_.emplace(georeference(), cols(), rows());
  return *planes_;
}

void MapInput::check_plane(const MetricPlane& plane, const dvec2& at) const {
  if (!(plane.error_cells > options_.plane_error)) return;
  std::string warp;
  if (const auto lonlat = lonlat_of(at.x, at.y); lonlat && body_.earth)
    warp = fmt::format(
        "; or first: gdalwarp -t_srs '+proj=aeqd +lat_0={:.6f} +lon_0={:.6f} +datum=WGS84' -r bilinear{} {} plane.tif",
        lonlat->y, lonlat->x, warp_words(), path());
  throw Error(fmt::format(
      "{}: samples are up to {:.2g} cells off the metric plane at {:.10g},{:.10g}, limit {} (set a distance limit; or "
      "raise --plane-error{})",
      path(), plane.error_cells, place_of(at.x, at.y).x, place_of(at.x, at.y).y, options_.plane_error, warp));
}

void MapInput::note_plane(const MetricPlane& plane) {
  constexpr double kNoticed = 0.1;  // cells, of projected rasters
  if ((!geographic_ && plane.error_cells < kNoticed) || std::exchange(plane_is_noted_, true)) return;
  notes.push_back(
      fmt::format("{}computed on a local metric plane, cells {:.6g} x {:.6g} m, samples up to {:.2g} cells off",
                  geographic_ ? "degrees: " : "", plane.cell_x, plane.cell_y, plane.error_cells));
}

MetricPlane MapInput::plane_at(const dvec2& at, double reach) {
  const std::pair key(at.x, at.y);
  if (const auto known = around_.find(key); known != around_.end() && known->second.reach >= reach)
    return known->second.plane;
  const MetricPlane plane = planes().around(at, reach);
  check_plane(plane, at);
  around_[key] = {reach, plane};
  return plane;
}

HeightField MapInput::field_at(double col, double row, double reach) {
  const MetricPlane plane = plane_at({col, row}, reach);
  note_plane(plane);
  return with_cells(field_, {plane.cell_x, plane.cell_y});
}

dvec2 MapInput::cells_at(double col, double row, double reach) {
  const MetricPlane plane = plane_at({col, row}, reach);
  return {plane.cell_x, plane.cell_y};
}

dvec2 MapInput::cells_along(const dvec2& from, const dvec2& to) {
  const MetricPlane plane = planes().along(from, to);
  check_plane(plane, 0.5 * (from + to));
  note_plane(plane);
  return {plane.cell_x, plane.cell_y};
}

double MapInput::distance(const dvec2& from, const dvec2& to) { return planes().distance(from, to); }

double MapInput::grid_north_at(double col, double row, double reach) {
  const MetricPlane plane = plane_at({col, row}, reach);
  return geographic_ ? plane.grid_north_azimuth : find_north({col, row}).value_or(plane.grid_north_azimuth);
}

std::optional<double> MapInput::find_north(const dvec2& at) const {
  const double step = kNorthStep_m / georeference().cell_y_m;
  const auto here = lonlat_of(at.x, at.y), north = lonlat_of(at.x, at.y - step), south = lonlat_of(at.x, at.y + step);
  if (!here || !north || !south) return std::nullopt;
  const auto point = [](const dvec2& lonlat) {
    return Ellipsoid().point(lonlat.x / kDegreesPerRadian, lonlat.y / kDegreesPerRadian);
  };
  const dvec3 chord = point(*north) - point(*south);
  const double lon = here->x / kDegreesPerRadian, lat = here->y / kDegreesPerRadian;
  return std::atan2(dot(chord, east_of(lon)), dot(chord, north_of(lon, lat)));
}

double MapInput::north_at(double col, double row) const {
  return find_north({col, row}).value_or(georeference().grid_north_azimuth);
}

double MapInput::turn_of_north() const {
  const auto centre_north = find_north(centre());
  double most = 0;
  for (const double col : {0.0, cols() - 1.0})
    for (const double row : {0.0, rows() - 1.0})
      if (const auto north = find_north({col, row}); north && centre_north)
        most = std::max(most, std::abs(std::remainder(*north - *centre_north, 2 * std::numbers::pi)));
  return most;
}

HeightField MapInput::whole_field(double reach) {
  return geographic_ ? field_at(centre().x, centre().y, reach) : field_;
}

dvec2 MapInput::whole_cells() {
  return geographic_ ? cells_at(centre().x, centre().y, HUGE_VAL)
                     : dvec2(georeference().cell_x_m, georeference().cell_y_m);
}

double MapInput::whole_grid_north() {
  if (geographic_) return grid_north_at(centre().x, centre().y, HUGE_VAL);
  return north_at(centre().x, centre().y);
}

std::optional<BilinearGround> MapInput::bilinear_ground(const HeightField& field) const {
  if (options_.surface != "bilinear") return std::nullopt;
  try {
    return BilinearGround(field);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path(), error.what()));
  }
}

}  // namespace scarp::cli
