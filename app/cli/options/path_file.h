// SPDX-License-Identifier: MIT
// Files of polylines as inputs of subcommands, and stations along them.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "app/cli/options/map_input.h"
#include "app/cli/options/place_file.h"

namespace scarp::cli {

/// Returns the polylines of a vector file, or with PlaceKind::paths also its polygons; the rows of a text table are the
/// vertices of one polyline. A note counts the vertices that were skipped. Throws Error naming the file.
PlaceTable read_paths(const PlaceFile& file, PlaceKind kind = PlaceKind::lines);

struct Vertex {
  dvec2 at{0.0};            ///< columns and rows of the raster
  std::optional<double> z;  ///< only if the file has it
};
using Polyline = std::vector<Vertex>;

/// Throws Error for a vertex outside the raster.
Polyline polyline_of(MapInput& input, const PlaceTable& table, std::size_t row);

/// Splits long segments, over which the scale of the map changes, and returns the lengths of all segments in metres.
std::vector<double> measure(MapInput& input, Polyline& line);

/// A point on a polyline.
struct Station {
  double distance = 0;  ///< along the line in metres
  Vertex vertex;        ///< z is linear between vertices that have it
};

/// Returns stations every `spacing` metres, and one at the end. `lengths`: of the segments. Throws Error that starts
/// with `option` for more than `most` stations.
std::vector<Station> stations_of(const Polyline& line, std::span<const double> lengths, double spacing,
                                 std::string_view option, double most);

}  // namespace scarp::cli
