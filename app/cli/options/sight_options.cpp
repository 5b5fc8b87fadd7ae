// SPDX-License-Identifier: MIT
#include "app/cli/options/sight_options.h"

#include <fmt/format.h>

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

SightEnds sight_ends(MapInput& input, const PlaceTable& table, std::size_t row, const SightHeights& heights) {
  const PlaceRow& one = table.rows[row];
  const auto end = [&](const TablePlace& place, double height, std::string_view option) {
    const std::string what = one.line > 0 ? table.where(row, &place == &one.to) : std::string(option);
    const dvec2 at = input.grid_of(place, table.lonlat, what);
    const bool sea = place.z && heights.datum == "sea";
    return SightEnd{at.x, at.y, place.z.value_or(height), sea ? HeightDatum::sea : HeightDatum::ground};
  };
  return {end(one.from, heights.observer, "--from"), end(one.to, heights.target, "--to")};
}

}  // namespace scarp::cli
