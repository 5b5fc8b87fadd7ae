// SPDX-License-Identifier: MIT
// Heights of observers and targets, and the ends of lines of sight, from options and tables.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/cli/options/map_input.h"
#include "app/cli/options/observer_columns.h"
#include "app/cli/options/place_file.h"
#include "scarp/analysis/line_of_sight.h"
#include "scarp/source/table/place_table.h"

namespace scarp::cli {

struct SightHeights {
  double observer = 2, target = 0;  ///< metres
  std::string datum;                ///< vertical reference of the heights of points; empty: by their source
  std::string z;                    ///< the same for files; empty: datum
};

/// Returns the meaning of z in a table: "ground", "sea" or "ignore".
std::string_view meaning_of_z(const SightHeights& heights, const PlaceTable& table);
/// Returns a note if places of a vector file have z whose meaning is assumed; otherwise nothing.
std::string note_of_z(const SightHeights& heights, const PlaceTable& table);

/// A height in metres and what it counts from.
struct DatumHeight {
  double metres = 0;
  HeightDatum datum = HeightDatum::ground;
};
/// The height of a place: z, to which a height column is added; else the column; else `fallback`. In place of z, a
/// column may hold the height of the ground (`spot`).
DatumHeight height_of(const TablePlace& place, std::string_view meaning, std::optional<double> column, double fallback,
                      std::optional<double> spot = std::nullopt);

/// Declares --observer-height, --target-height and --heights.
void add_sight_heights(Command& command, SightHeights& heights);
/// Declares --observer-z, with a rule that needs the file of the option `file`.
void add_observer_z(Command& command, SightHeights& heights, std::string_view file, const PlaceFile& places);

/// Declares --frequency, in megahertz.
void add_frequency_option(Command& command, std::optional<double>& megahertz, std::vector<Rule> rules = {},
                          std::vector<std::string> excludes = {});
/// Wavelength in metres of a frequency in megahertz.
inline double wavelength_of(double megahertz) { return 299.792458 / megahertz; }

/// Parses X,Y or X,Y,HEIGHT. Throws Error "OPTION 'TEXT': expected ...".
TablePlace typed_height_place(const std::string& text, std::string_view option);

/// Lines between points.
struct SightPlaces {
  std::vector<std::string> from, to;  ///< X,Y[,H]
  PlaceFile lines;                    ///< with pairs: of points
  bool pairs = false;                 ///< lines between all pairs of points
};

/// Declares --from, --to, --lines, --pairs, --layer and --skip-bad.
void add_sight_places(Command& command, SightPlaces& places);

/// Returns the lines from each --from to each --to, or those of --lines, or between all pairs. Throws Error.
PlaceTable sight_places(const SightPlaces& places);

/// The ends of one line.
struct SightEnds {
  SightEnd from, to;
};
/// Returns the point of a line at `along`, 0 to 1, in columns and rows.
dvec2 point_along(const SightEnds& ends, double along);
/// Columns with heights of the ends. Tables of pairs have those of the points, with suffixes.
struct SightColumns {
  SightColumns(const PlaceTable& table, bool between_pairs)
      : pairs(between_pairs), from(table, pairs ? "_from" : ""), to(table, pairs ? "_to" : "") {}

  bool pairs;
  ObserverColumns from, to;
};
/// Positions count from the raster's north-west sample.
SightEnds sight_ends(MapInput& input, const PlaceTable& table, std::size_t row, const SightHeights& heights,
                     const SightColumns& columns);

}  // namespace scarp::cli
