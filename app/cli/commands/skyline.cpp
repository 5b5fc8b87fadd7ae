// SPDX-License-Identifier: MIT
#include "app/cli/commands/skyline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/cli/options/map_part.h"
#include "app/cli/options/plot_options.h"
#include "app/cli/progress.h"
#include "scarp/analysis/line_of_sight.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/progress_part.h"
#include "scarp/base/replace_file.h"

namespace scarp::cli {
namespace {

constexpr std::size_t kMostLayers = 7;
constexpr double kLeastCells = 8;

// Distances that divide the ground into layers: 1, 2 or 5 times a power of ten, from the farthest to the nearest. There
// is no ground between crossings, so edges of layers that are only a few cells away would be ragged.
std::vector<double> layer_distances(double farthest, double nearest) {
  std::vector<double> distances;
  if (!(farthest > 0)) return distances;
  for (double power = std::pow(10, std::floor(std::log10(farthest))); distances.size() < kMostLayers; power /= 10) {
    for (const double step : {5.0, 2.0, 1.0}) {
      if (step * power < nearest || distances.size() + 1 == kMostLayers) return distances;
      if (step * power < farthest) distances.push_back(step * power);
    }
  }
  return distances;
}

std::string distance_text(double metres) {
  return metres < 1000 ? fmt::format("{:g} m", metres) : fmt::format("{:g} km", metres / 1000);
}

// Degrees of each view, and of the first again.
std::vector<double> elevations_of(const std::vector<HorizonView>& views) {
  std::vector<double> all;
  for (const HorizonView& view : views) all.push_back(view.angle * kDegreesPerRadian);
  all.push_back(all.front());
  return all;
}

}  // namespace

SkylineNames::SkylineNames(const std::string& path) {
  if (path.empty()) return;
  table_ = read_places(path, PlaceKind::points);
  ignore_vector_z(table_);
  const auto& columns = table_.carried.names;
  if (columns.empty()) throw Error(fmt::format("{}: no column with names (add one: name)", path));
  const auto named = std::find_if(columns.begin(), columns.end(),
                                  [](const std::string& column) { return lower_case(column) == "name"; });
  column_ = named == columns.end() ? 0 : static_cast<std::size_t>(named - columns.begin());
}

std::vector<SkylineLabel> SkylineNames::visible_from(MapInput& input, const HorizonPlace& place,
                                                     const HorizonSettings& settings, std::string& note) const {
  std::vector<SkylineLabel> labels;
  if (table_.rows.empty()) return labels;
  const HeightField field = input.field_at(place.at.x, place.at.y, settings.max_distance);
  const double grid_north = input.north_at(place.at.x, place.at.y);
  const HeightFieldSettings& cells = field.settings();
  const SightEnd eye = in_part(input, SightEnd{place.at.x, place.at.y, place.eye_height});
  const SightGround ground(field);
  int hidden = 0, outside = 0;
  for (std::size_t i = 0; i < table_.rows.size(); ++i) {
    const std::string what = table_.where(i);
    const TablePlace& typed = table_.rows[i].from;
    if (typed.z.value_or(0) < 0)
      throw Error(fmt::format("{}: height {:.10g}: expected at least 0 metres above the ground", what, *typed.z));
    const dvec2 at = input.position_of(typed, table_.lonlat, what);
    const SightEnd target = in_part(input, SightEnd{at.x, at.y, typed.z.value_or(0)});
    const double east = (target.col - eye.col) * cells.cell_x, north = (eye.row - target.row) * cells.cell_y;
    const double distance = std::hypot(east, north);
    if (!(distance > 0 && distance <= settings.max_distance) ||
        !ground.height_at(rounded_end(target.col), rounded_end(target.row))) {
      ++outside;
      continue;
    }
    if (!line_of_sight(field, eye, target, settings.curvature).visible) {
      ++hidden;
      continue;
    }
    const SightLine line(field, eye, target, settings.curvature);
    labels.push_back({{(compass_azimuth(east, north) + grid_north) * kDegreesPerRadian,
                       std::atan2(line.target() - line.eye(), distance) * kDegreesPerRadian},
                      table_.carried.at(i, column_)});
  }
  note = fmt::format("{}: {} of {} points are visible, {} are hidden by the ground", table_.path, labels.size(),
                     table_.rows.size(), hidden);
  if (outside > 0) note += fmt::format(", {} are outside the model or the distance, or over holes", outside);
  return labels;
}

SkylineFigure skyline_of(MapInput& input, const HorizonPlace& place, double first_azimuth, int count,
                         const HorizonSettings& settings) {
  SkylineFigure figure;
  for (int i = 0; i <= count; ++i) figure.azimuths.push_back(first_azimuth + 360.0 * i / count);
  const std::vector<double> azimuths(figure.azimuths.begin(), figure.azimuths.end() - 1);
  const Progress progress = terminal_progress("horizon");
  // The first takes as long as all others: they end earlier.
  const auto views = horizons_at(input, place, azimuths, settings, progress_part(progress, 0, 2));
  double farthest = 0;
  for (const HorizonView& view : views) farthest = std::max(farthest, view.distance.value_or(0));
  figure.layers.push_back({"", elevations_of(views)});
  const dvec2 cell = input.cells_at(place.at.x, place.at.y, settings.max_distance);
  const std::vector<double> distances = layer_distances(farthest, kLeastCells * std::max(cell.x, cell.y));
  const auto parts = static_cast<double>(2 * distances.size());
  for (std::size_t i = 0; i < distances.size(); ++i) {
    HorizonSettings nearer = settings;
    nearer.max_distance = distances[i];
    const Progress part = progress_part(progress, static_cast<double>(distances.size() + i), parts);
    figure.layers.push_back({"", elevations_of(horizons_at(input, place, azimuths, nearer, part))});
  }
  for (std::size_t i = 0; i < distances.size(); ++i) {
    figure.layers[i].name = i == 0 ? "over " + distance_text(distances[0])
                                   : distance_text(distances[i]) + " to " + distance_text(distances[i - 1]);
  }
  if (!distances.empty()) figure.layers.back().name = "up to " + distance_text(distances.back());
  return figure;
}

std::string skyline_title(const MapInput& input, const HorizonPlace& place) {
  const dvec2 at = input.place_of(place.at.x, place.at.y);
  return fmt::format("skyline at {:.10g}, {:.10g}, eye {:.6g} m above the ground", at.x, at.y, place.eye_height);
}

#ifdef SCARP_CAIRO

void draw_skyline(const HorizonOptions& options, MapInput& input, const PlaceTable& point, const SkylineNames& names) {
  constexpr int kUsualWidth = 1200, kUsualHeight = 480;
  const auto [width, height] = plot_size(options.size, kUsualWidth, kUsualHeight);
  const HorizonSettings settings = horizon_settings(options.horizon, input);
  const HorizonPlace place = horizon_place(input, point, 0, horizon_position(input, point, 0), settings);
  input.read(place.part, terminal_progress("read"));
  input.close();
  SkylineFigure figure =
      skyline_of(input, place, options.first_azimuth, static_cast<int>(options.all_azimuths().size()), settings);
  std::string note;
  figure.labels = names.visible_from(input, place, settings, note);
  figure.title = skyline_title(input, place);
  figure.remark = input.curvature_text();
  figure.width = width, figure.height = height;
  ReplaceFile file(options.output);
  const int left_out = write_skyline_figure(file, options.output, figure);
  if (left_out > 0) note += fmt::format("; {} names have no room", left_out);
  if (!note.empty()) input.notes.push_back(note);
  print_notes(input.notes);
  const auto& skyline = figure.layers.front().elevation;
  const auto highest = std::max_element(skyline.begin(), skyline.end());
  fmt::print("{}: highest {:.4g} degrees at azimuth {:.4g}; {}\n", options.output, *highest,
             std::fmod(figure.azimuths[static_cast<std::size_t>(highest - skyline.begin())], 360.0),
             input.curvature_text());
}

#else

void draw_skyline(const HorizonOptions&, MapInput&, const PlaceTable&, const SkylineNames&) {}

#endif

}  // namespace scarp::cli
