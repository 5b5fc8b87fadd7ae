// SPDX-License-Identifier: MIT
#include "app/cli/commands/horizon_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/map_part.h"
#include "app/cli/options/sight_options.h"
#include "app/cli/progress.h"
#include "scarp/base/csv_text.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/parallel.h"
#include "scarp/base/progress_part.h"
#include "scarp/base/replace_file.h"
#include "scarp/source/table/place_table.h"
#include "scarp/source/whole_file.h"

namespace scarp::cli {
namespace {

PlaceTable points_of(const HorizonOptions& options) {
  if (!options.points.path.empty()) return options.points.read(PlaceKind::points);
  PlaceTable table;
  for (const std::string& text : options.at) table.rows.push_back({typed_height_place(text, "--at"), {}, 0});
  return table;
}

// A point with a horizon.
struct Point {
  std::string what;  // for messages
  dvec2 at;          // columns and rows of the raster
  double eye_height = 0;
  RasterWindow part;  // the samples that its horizon depends on
};

// Positions that differ from a grid line by the rounding of coordinates are on the line: beside it may be a hole.
double on_line(double position) {
  const double line = std::round(position);
  return std::abs(position - line) <= 0.5 / kSubcells ? line : position;
}

// The points in good rows.
std::vector<Point> located(MapInput& input, const PlaceTable& table, const HorizonSettings& settings,
                           RowStatus& status) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const PlaceRow& row = table.rows[i];
    const std::string what = row.line > 0 ? table.where(i) : "--at";
    dvec2 at(0.0);
    status.attempt(i, RowStatus::kOutside, [&] {
      const dvec2 exact = input.grid_of(row.from, table.lonlat, what);
      at = {on_line(exact.x), on_line(exact.y)};
    });
    status.attempt(i, RowStatus::kInvalid, [&] {
      const double eye_height = row.from.z.value_or(settings.eye_height);
      if (eye_height < 0)
        throw Error(fmt::format("{}: height {:.10g}: expected at least 0 metres above the ground", what, eye_height));
      // Only ground within the distance matters, and one cell beyond it: the last crossings lie between samples.
      const Node node{static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y))};
      const dvec2 cell = input.cells_at(at.x, at.y, settings.max_distance);
      points.push_back(
          {what, at, eye_height, part_around(input, node, settings.max_distance + 2 * std::max(cell.x, cell.y))});
    });
  }
  status.require_good();
  return points;
}

// Horizons of one point, over the part that was read.
std::vector<HorizonView> horizons_at(MapInput& input, const Point& point, const std::vector<double>& azimuths,
                                     HorizonSettings settings, const Progress& progress) {
  settings.eye_height = point.eye_height;
  const HeightField field = input.field_at(point.at.x, point.at.y, settings.max_distance);
  const double grid_north = input.grid_north_at(point.at.x, point.at.y, settings.max_distance);
  const SightEnd local = in_part(input, SightEnd{point.at.x, point.at.y});
  std::vector<HorizonView> views(azimuths.size());
  constexpr std::int64_t kGrain = 8;
  parallel_for(
      static_cast<std::int64_t>(azimuths.size()), kGrain,
      [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
          const auto view =
              horizon_from(field, local.col, local.row, azimuths[i] / kDegreesPerRadian - grid_north, settings);
          if (!view) throw Error(fmt::format("{}: the point is over a hole", point.what));
          views[i] = *view;
        }
      },
      progress);
  return views;
}

std::string table_of(const HorizonOptions& options, MapInput& input, const PlaceTable& table) {
  const bool skips = options.points.skip_bad;
  RowStatus status(table, skips);
  const HorizonSettings settings = horizon_settings(options.horizon, input);
  const std::vector<Point> points = located(input, table, settings, status);
  std::vector<RasterWindow> parts;
  for (const Point& point : points) parts.push_back(point.part);
  const bool together = read_together(input, parts);
  const std::vector<double> azimuths = options.all_azimuths();
  const Progress progress = terminal_progress("horizon");
  std::string text, carried;
  for (const std::string& name : table.carried.names) append_csv_text(text, name), text += ',';
  text += fmt::format("point,horizon_azimuth,horizon_elevation,distance{}\n", skips ? ",status" : "");
  std::size_t next = 0;  // of `points`
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    std::vector<HorizonView> views;
    if (status.good(row)) {
      if (!together) input.read(parts[next], {});
      const Progress of_point = progress_part(progress, static_cast<double>(next), static_cast<double>(points.size()));
      status.attempt(row, RowStatus::kNodata,
                     [&] { views = horizons_at(input, points[next], azimuths, settings, of_point); });
      ++next;
    }
    carried.clear();
    for (std::size_t k = 0; k < table.carried.names.size(); ++k)
      append_csv_text(carried, table.carried.at(row, k)), carried += ',';
    if (!status.good(row)) text += fmt::format("{}{},,,,{}\n", carried, row + 1, status.of(row));
    for (std::size_t k = 0; k < views.size(); ++k) {
      const double angle = options.clamp ? std::max(views[k].angle, 0.0) : views[k].angle;
      text += fmt::format("{}{},{:.10g},{:.6f},{}{}\n", carried, row + 1, azimuths[k], angle * kDegreesPerRadian,
                          views[k].distance ? fmt::format("{:.10g}", *views[k].distance) : "", skips ? ",ok" : "");
    }
  }
  if (const std::string note = status.note(); !note.empty()) input.notes.push_back(note);
  return text;
}

}  // namespace

std::vector<double> HorizonOptions::all_azimuths() const {
  constexpr int kMapAzimuths = 16, kPointAzimuths = 360;
  const int count = azimuths.value_or(at_points() ? kPointAzimuths : kMapAzimuths);
  std::vector<double> all;
  for (int i = 0; i < count; ++i) all.push_back(std::fmod(first_azimuth + 360.0 + 360.0 * i / count, 360.0));
  return all;
}

void write_point_horizons(HorizonOptions options) {
  if (options.output == "-") options.output.clear();
  const bool to_file = !options.output.empty();
  if (to_file && extension_of(options.output) != ".csv")
    throw Error(fmt::format("output '{}': expected .csv with --at or --points", options.output));
  keep_inputs(options.output, options.typed);
  const ThreadLimit limit(options.threads);
  const PlaceTable table = points_of(options);
  MapInput input(options);
  input.notes.insert(input.notes.end(), table.notes.begin(), table.notes.end());
  keep_inputs(options.output, input.files());
  if (to_file) const ReplaceFile writable(options.output);
  const std::string text = table_of(options, input, table);
  if (to_file) {
    write_whole_file(options.output, text);
    fmt::print("{}: {} points; {}\n", options.output, table.rows.size(), input.curvature_text());
  } else {
    fmt::print("{}", text);
  }
  for (const std::string& note : input.notes) fmt::print(stderr, "note: {}\n", note);
}

}  // namespace scarp::cli
