// SPDX-License-Identifier: MIT
#include "app/cli/commands/horizon_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "app/cli/options/map_part.h"
#include "scarp/base/csv_text.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/base/progress_part.h"

namespace scarp::cli {
namespace {

// Positions that differ from a grid line by the rounding of coordinates are on the line: beside it may be a hole.
double on_line(double position) {
  const double line = std::round(position);
  return std::abs(position - line) <= 0.5 / kSubcells ? line : position;
}

std::string name_of(const PlaceTable& table, std::size_t row) {
  return table.rows[row].line > 0 ? table.where(row) : "--at";
}

}  // namespace

dvec2 horizon_position(MapInput& input, const PlaceTable& table, std::size_t row) {
  const dvec2 exact = input.grid_of(table.rows[row].from, table.lonlat, name_of(table, row));
  return {on_line(exact.x), on_line(exact.y)};
}

HorizonPlace horizon_place(MapInput& input, const PlaceTable& table, std::size_t row, const dvec2& at,
                           const HorizonSettings& settings) {
  const std::string what = name_of(table, row);
  const double eye_height = table.rows[row].from.z.value_or(settings.eye_height);
  if (eye_height < 0)
    throw Error(fmt::format("{}: height {:.10g}: expected at least 0 metres above the ground", what, eye_height));
  // Only ground within the distance matters, and one cell beyond it: the last crossings lie between samples.
  const Node node{static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y))};
  const dvec2 cell = input.cells_at(at.x, at.y, settings.max_distance);
  return {what, at, eye_height, part_around(input, node, settings.max_distance + 2 * std::max(cell.x, cell.y))};
}

void visit_places(
    MapInput& input, const PlaceTable& table, const HorizonSettings& settings, RowStatus& status,
    const Progress& progress,
    const std::function<void(std::size_t row, const HorizonPlace& place, const Progress& progress)>& use) {
  std::vector<HorizonPlace> places;
  std::vector<RasterWindow> parts;
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    dvec2 at(0.0);
    status.attempt(row, RowStatus::kOutside, [&] { at = horizon_position(input, table, row); });
    status.attempt(row, RowStatus::kInvalid, [&] {
      places.push_back(horizon_place(input, table, row, at, settings));
      parts.push_back(places.back().part);
      rows.push_back(row);
    });
  }
  status.require_good();
  const bool together = read_together(input, parts);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!together) input.read(parts[i], {});
    const Progress of_place = progress_part(progress, static_cast<double>(i), static_cast<double>(places.size()));
    status.attempt(rows[i], RowStatus::kNodata, [&] { use(rows[i], places[i], of_place); });
  }
  if (const std::string note = status.note(); !note.empty()) input.notes.push_back(note);
}

std::string carried_names(const PlaceTable& table) {
  std::string text;
  for (const std::string& name : table.carried.names) append_csv_text(text, name), text += ',';
  return text;
}

std::string carried_texts(const PlaceTable& table, std::size_t row) {
  std::string text;
  for (std::size_t k = 0; k < table.carried.names.size(); ++k)
    append_csv_text(text, table.carried.at(row, k)), text += ',';
  return text;
}

std::vector<HorizonView> horizons_at(MapInput& input, const HorizonPlace& place, const std::vector<double>& azimuths,
                                     HorizonSettings settings, const Progress& progress) {
  settings.eye_height = place.eye_height;
  const HeightField field = input.field_at(place.at.x, place.at.y, settings.max_distance);
  const double grid_north = input.north_at(place.at.x, place.at.y);
  const SightEnd local = in_part(input, SightEnd{place.at.x, place.at.y});
  std::vector<HorizonView> views(azimuths.size());
  constexpr std::int64_t kGrain = 8;
  parallel_for(
      static_cast<std::int64_t>(azimuths.size()), kGrain,
      [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
          const auto view =
              horizon_from(field, local.col, local.row, azimuths[i] / kDegreesPerRadian - grid_north, settings);
          if (!view) throw Error(fmt::format("{}: the point is over a hole", place.what));
          views[i] = *view;
        }
      },
      progress);
  return views;
}

}  // namespace scarp::cli
