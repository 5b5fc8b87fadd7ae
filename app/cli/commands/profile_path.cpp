// SPDX-License-Identifier: MIT
#include "app/cli/commands/profile_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/map_part.h"
#include "app/cli/progress.h"
#include "scarp/analysis/sight.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/source/whole_file.h"

namespace scarp::cli {
namespace {

// A polyline in columns and rows.
using Polyline = std::vector<dvec2>;

// The polylines of a vector file; the rows of a text table are the vertices of one.
PlaceTable paths_of(const PlaceFile& file) {
  const std::string extension = extension_of(file.path);
  const bool text = file.path == "-" || extension == ".csv" || extension == ".txt" || extension == ".tsv";
  PlaceTable table =
      read_places(file.path, text ? PlaceKind::points : PlaceKind::lines, {file.layer, true, file.skip_bad});
  if (!text) return table;
  const std::size_t all = table.rows.size();
  std::string first;  // why
  std::erase_if(table.rows, [&](const PlaceRow& row) {
    if (first.empty()) first = row.bad;
    return !row.bad.empty();
  });
  if (!first.empty())
    table.notes.push_back(fmt::format("{} of {} vertices skipped; the first: {}", all - table.rows.size(), all, first));
  if (table.rows.size() < 2) throw Error(fmt::format("{}: a path needs at least two vertices", file.path));
  PlaceRow path{table.rows.front().from, table.rows.back().from, table.rows.front().line};
  for (std::size_t i = 1; i + 1 < table.rows.size(); ++i) path.between.push_back(table.rows[i].from);
  table.rows = {std::move(path)};
  return table;
}

Polyline polyline_of(MapInput& input, const PlaceTable& table, std::size_t row) {
  const PlaceRow& path = table.rows[row];
  const std::string what = table.where(row);
  Polyline line{input.grid_of(path.from, table.lonlat, what)};
  for (const TablePlace& vertex : path.between) line.push_back(input.grid_of(vertex, table.lonlat, what));
  line.push_back(input.grid_of(path.to, table.lonlat, what));
  return line;
}

// Length of a segment in metres.
double length_of(const dvec2& from, const dvec2& to, const dvec2& cell) {
  return std::hypot((to.x - from.x) * cell.x, (to.y - from.y) * cell.y);
}

// The part that the heights along a polyline depend on.
RasterWindow part_of(const MapInput& input, const Polyline& line) {
  std::vector<RasterWindow> parts;
  for (std::size_t i = 1; i < line.size(); ++i)
    parts.push_back(part_of_line(input, SightEnd{line[i - 1].x, line[i - 1].y}, SightEnd{line[i].x, line[i].y}));
  return union_of(parts);
}

// Rows at every `spacing` metres, and at the end.
std::string rows_of(MapInput& input, std::size_t number, const Polyline& line, std::optional<double> typed,
                    std::string_view status) {
  input.read(part_of(input, line), terminal_progress("read"));
  double reach = 0;
  const dvec2 first = line.front(), here = input.cells_at(first.x, first.y, 0);
  for (const dvec2& vertex : line) reach = std::max(reach, length_of(first, vertex, here));
  const HeightField field = input.field_at(first.x, first.y, reach);
  const dvec2 cell{field.settings().cell_x, field.settings().cell_y};
  const double spacing = typed.value_or(std::min(cell.x, cell.y));
  const SightGround ground(field);
  std::string text;
  const auto add = [&](double station, const dvec2& at) {
    const SightEnd local = in_part(input, SightEnd{at.x, at.y});
    const auto height = ground.height_at(local.col, local.row);
    const dvec2 place = input.place_of(at.x, at.y);
    text += fmt::format("{},{:.10g},{:.10g},{:.10g},{}{}\n", number, station, place.x, place.y,
                        height ? fmt::format("{:.10g}", *height) : "", status);
  };
  double before = 0, total = 0;  // metres up to the segment, and of all
  for (std::size_t i = 1; i < line.size(); ++i) total += length_of(line[i - 1], line[i], cell);
  constexpr double kMostStations = 1e8;
  if (total / spacing > kMostStations)
    throw Error(
        fmt::format("--spacing {:.10g}: more than {:.0f} stations over {:.6g} m", spacing, kMostStations, total));
  std::int64_t station = 0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double length = length_of(line[i - 1], line[i], cell);
    for (; static_cast<double>(station) * spacing < before + length; ++station) {
      const double along = (static_cast<double>(station) * spacing - before) / length;
      add(static_cast<double>(station) * spacing, line[i - 1] + along * (line[i] - line[i - 1]));
    }
    before += length;
  }
  add(before, line.back());
  return text;
}

}  // namespace

void add_profile_path_options(Command& command, ProfilePath& options) {
  add_place_file(command, options.file,
                 {.names = "--path",
                  .value = "FILE",
                  .help = "polylines instead of a line of sight: a vector file of lines, or CSV with a row per vertex",
                  .files = "csv geojson gpkg shp",
                  .note = "-: CSV from standard input",
                  .common = true,
                  .excludes = {"--from", "--to", "--march", "--ray"}});
  command.add(&options.spacing, {.names = "--spacing",
                                 .help = "distance between stations along --path",
                                 .unit = "metres",
                                 .range = kAboveZero,
                                 .fallback = "a cell",
                                 .common = true,
                                 .rules = {needs("--path FILE", [&options] { return !options.file.path.empty(); })}});
}

void write_path_profiles(const ProfilePath& options, const MapOptions& map, const std::string& output) {
  if (!output.empty() && extension_of(output) != ".csv")
    throw Error(fmt::format("output '{}': expected .csv with --path", output));
  const PlaceTable table = paths_of(options.file);
  MapInput input(map);
  keep_inputs(output, input.files());
  input.notes.insert(input.notes.end(), table.notes.begin(), table.notes.end());
  const bool skips = options.file.skip_bad;
  RowStatus status(table, skips);
  std::string text = fmt::format("path,distance,x,y,ground{}\n", skips ? ",status" : "");
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    Polyline line;
    status.attempt(i, RowStatus::kOutside, [&] { line = polyline_of(input, table, i); });
    status.attempt(i, RowStatus::kInvalid,
                   [&] { text += rows_of(input, i + 1, line, options.spacing, skips ? ",ok" : ""); });
    if (!status.good(i)) text += fmt::format("{},,,,,{}\n", i + 1, status.of(i));
  }
  if (const std::string note = status.note(); !note.empty()) input.notes.push_back(note);
  if (output.empty()) {
    fmt::print("{}", text);
  } else {
    write_whole_file(output, text);
  }
  print_notes(input.notes);
  if (!output.empty()) fmt::print("{}: {} paths\n", output, table.rows.size());
}

}  // namespace scarp::cli
