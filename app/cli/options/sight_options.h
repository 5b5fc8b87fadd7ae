// SPDX-License-Identifier: MIT
// Heights of observers and targets, and the ends of lines of sight, from options and tables.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/map_input.h"
#include "app/cli/options/place_file.h"
#include "scarp/analysis/line_of_sight.h"
#include "scarp/source/table/place_table.h"

namespace scarp::cli {

struct SightHeights {
  double observer = 2, target = 0;  ///< metres
  std::string datum = "ground";     ///< vertical reference of the heights of points
};

/// Declares --observer-height, --target-height and --heights.
void add_sight_heights(Command& command, SightHeights& heights);

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
/// Positions count from the raster's north-west sample.
SightEnds sight_ends(MapInput& input, const PlaceTable& table, std::size_t row, const SightHeights& heights);

}  // namespace scarp::cli
