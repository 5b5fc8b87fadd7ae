// SPDX-License-Identifier: MIT
#include "app/cli/commands/profile_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/map_part.h"
#include "app/cli/options/path_file.h"
#include "app/cli/progress.h"
#include "scarp/analysis/sight.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/source/whole_file.h"

namespace scarp::cli {
namespace {

// The part that the heights along a polyline depend on.
RasterWindow part_of(const MapInput& input, const Polyline& line) {
  const auto end = [](const Vertex& vertex) { return SightEnd{vertex.at.x, vertex.at.y}; };
  std::vector<RasterWindow> parts;
  for (std::size_t i = 1; i < line.size(); ++i) parts.push_back(part_of_line(input, end(line[i - 1]), end(line[i])));
  return union_of(parts);
}

// Rows at every `spacing` metres, and at the end.
std::string rows_of(MapInput& input, std::size_t number, Polyline line, std::optional<double> typed,
                    std::string_view status) {
  input.read(part_of(input, line), terminal_progress("read"));
  const dvec2 first = line.front().at, cell = input.cells_at(first.x, first.y, 0);
  const std::vector<double> lengths = measure(input, line);
  constexpr double kMostStations = 1e8;
  const auto stations =
      stations_of(line, lengths, typed.value_or(std::min(cell.x, cell.y)), "--spacing", kMostStations);
  const SightGround ground(input.field());
  std::string text;
  for (const Station& station : stations) {
    const dvec2 at = station.vertex.at, place = input.place_of(at.x, at.y);
    const SightEnd local = in_part(input, SightEnd{at.x, at.y});
    const auto height = ground.height_at(local.col, local.row);
    text += fmt::format("{},{:.10g},{:.10g},{:.10g},{}{}\n", number, station.distance, place.x, place.y,
                        height ? fmt::format("{:.10g}", *height) : "", status);
  }
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
  const PlaceTable table = read_paths(options.file);
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
