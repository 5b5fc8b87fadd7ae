// SPDX-License-Identifier: MIT
#include "app/cli/options/sight_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/options/numbers.h"
#include "scarp/base/error.h"

namespace scarp::cli {
TablePlace typed_height_place(const std::string& text, std::string_view option) {
  const auto n = ground_numbers_from(text, 2, 3, option, "X,Y or X,Y,HEIGHT, for example 692000,5143000,2");
  return {n[0], n[1], n.size() > 2 ? std::optional(n[2]) : std::nullopt};
}

void add_sight_heights(Command& command, SightHeights& heights) {
  command.add(&heights.observer, {.names = "--observer-height",
                                  .help = "default height of observers above ground",
                                  .unit = "metres",
                                  .range = {0, kMostOfGround},
                                  .common = true});
  command.add(&heights.target, {.names = "--target-height",
                                .help = "default height of targets above ground",
                                .unit = "metres",
                                .range = {0, kMostOfGround},
                                .common = true});
  command.add(&heights.datum, {.names = "--heights",
                               .value = "DATUM",
                               .help = "reference of the heights of points",
                               .choices = {"ground", "sea"},
                               .closed = true,
                               .fallback = "ground; vector Z: sea",
                               .common = true});
}

void add_frequency_option(Command& command, std::optional<double>& megahertz, std::vector<Rule> rules,
                          std::vector<std::string> excludes) {
  command.add(&megahertz, {.names = "--frequency",
                           .value = "MHZ",
                           .help = "radio frequency for the clearance of the first Fresnel zone",
                           .unit = "megahertz",
                           .range = {1, 1e6},
                           .fallback = "none",
                           .rules = std::move(rules),
                           .excludes = std::move(excludes)});
}

void add_observer_z(Command& command, SightHeights& heights, std::string_view file, const PlaceFile& places) {
  command.add(&heights.z, {.names = "--observer-z",
                           .value = "KIND",
                           .help = fmt::format("reference of z in {}", file),
                           .choices = {"ground", "sea", "ignore"},
                           .closed = true,
                           .fallback = "as --heights",
                           .rules = {needs(fmt::format("{} FILE", file), [&places] { return !places.path.empty(); })}});
}

std::string_view meaning_of_z(const SightHeights& heights, const PlaceTable& table) {
  if (!heights.z.empty()) return heights.z;
  if (!heights.datum.empty()) return heights.datum;
  return table.vector ? "sea" : "ground";
}

std::string note_of_z(const SightHeights& heights, const PlaceTable& table) {
  const bool assumed = table.vector && heights.z.empty() && heights.datum.empty();
  const auto has_z = [](const PlaceRow& row) { return row.from.z.has_value(); };
  return assumed && std::any_of(table.rows.begin(), table.rows.end(), has_z)
             ? fmt::format("{}: Z is a height above the sea (--observer-z)", table.path)
             : "";
}

DatumHeight height_of(const TablePlace& place, std::string_view meaning, std::optional<double> column, double fallback,
                      std::optional<double> spot) {
  if (spot) return {*spot + column.value_or(fallback), HeightDatum::sea};
  if (!place.z || meaning == "ignore") return {column.value_or(fallback)};
  return {*place.z + column.value_or(0), meaning == "sea" ? HeightDatum::sea : HeightDatum::ground};
}

void add_sight_places(Command& command, SightPlaces& places) {
  command.add(&places.from, {.names = "--from",
                             .value = "X,Y[,H]",
                             .help = "observer",
                             .note = "repeatable",
                             .repeats = true,
                             .common = true});
  command.add(&places.to, {.names = "--to",
                           .value = "X,Y[,H]",
                           .help = "target",
                           .note = "repeatable: every observer looks at every target",
                           .repeats = true,
                           .common = true});
  add_place_file(command, places.lines,
                 {.names = "--lines",
                  .value = "FILE",
                  .help = "lines: CSV (x,y[,z],tx,ty[,tz]) or a vector file (GeoJSON, GeoPackage, ...)",
                  .files = "csv geojson gpkg shp",
                  .note = "-: CSV from standard input",
                  .common = true,
                  .excludes = {"--from", "--to"}});
  command.add(&places.pairs,
              {.names = "--pairs",
               .help = "lines between all pairs of --from, or of the points of --lines, each at --observer-height",
               .common = true,
               .excludes = {"--to", "--target-height"}});
}

PlaceTable sight_places(const SightPlaces& places) {
  if (places.pairs) {
    PlaceTable points;
    for (const std::string& from : places.from) points.rows.push_back({typed_height_place(from, "--from"), {}, 0});
    return pairs_of(places.lines.path.empty() ? points : places.lines.read(PlaceKind::points));
  }
  if (!places.lines.path.empty()) return places.lines.read(PlaceKind::lines);
  if (places.from.empty() || places.to.empty()) throw Error("no lines of sight: give --from and --to, or --lines FILE");
  PlaceTable table;
  for (const std::string& from : places.from)
    for (const std::string& to : places.to)
      table.rows.push_back({typed_height_place(from, "--from"), typed_height_place(to, "--to"), 0});
  return table;
}

dvec2 point_along(const SightEnds& ends, double along) {
  // As SightLine::col(), but with the whole raster's columns: rounding does not depend on the part that was read.
  const auto at = [&](double from, double to) {
    return rounded_end(from) + along * (rounded_end(to) - rounded_end(from));
  };
  return {at(ends.from.col, ends.to.col), at(ends.from.row, ends.to.row)};
}

SightEnds sight_ends(MapInput& input, const PlaceTable& table, std::size_t row, const SightHeights& heights,
                     const SightColumns& columns) {
  const PlaceRow& one = table.rows[row];
  const std::string_view meaning = meaning_of_z(heights, table);
  const auto end = [&](const TablePlace& place, std::optional<double> column, double fallback,
                       std::string_view option) {
    const std::string what = one.line > 0 ? table.where(row, &place == &one.to) : std::string(option);
    const dvec2 at = input.grid_of(place, table.lonlat, what);
    const auto [metres, datum] = height_of(place, meaning, column, fallback);
    return SightEnd{at.x, at.y, metres, datum};
  };
  return {end(one.from, columns.from.number(row, ObserverColumn::height), heights.observer, "--from"),
          end(one.to, columns.to.number(row, columns.pairs ? ObserverColumn::height : ObserverColumn::target_height),
              heights.target, "--to")};
}

}  // namespace scarp::cli
