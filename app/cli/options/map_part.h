// SPDX-License-Identifier: MIT
// The part of a raster that a question depends on, so that only this part is read.
//
//   viewshed       all nodes within the maximum distance: a line of sight stays in the box of observer and target
//   line of sight  the box of its ends, and one more cell on each side: ends on a grid line touch both of its cells
//   horizons       the rows of the nodes, and as many on each side as the maximum distance has cells, and two more: a
//                  crossing lies between two samples, and slopes reach one sample further
//
// Answers are those of the whole raster, because parts keep its cell lengths (source/raster/opened_raster.h) and
// because all borders of a part lie beyond the nodes that the answer depends on, except the raster's own.
#pragma once

#include <span>
#include <string_view>

#include "app/cli/options/map_input.h"
#include "scarp/analysis/line_of_sight.h"

namespace scarp::cli {

/// Returns the nodes within `distance` metres of a node, on the plane there. `distance` may be infinite.
RasterWindow part_around(MapInput& input, const Node& node, double distance);

/// Returns the nodes that a line between two positions inside the raster depends on.
RasterWindow part_of_line(const MapInput& input, const SightEnd& from, const SightEnd& to);

/// Returns the smallest part that contains all of `parts`, of which there is at least one.
RasterWindow union_of(std::span<const RasterWindow> parts);

/// Whether the parts, read at once or in turn, take much memory, whereas `reads` other parts of `samples` in all, which
/// are read in turn, hold fewer samples.
bool are_wasteful(std::span<const RasterWindow> parts, double samples, double reads);

/// Whether the union of the parts is so much larger than the parts that they should be read one after the other.
bool are_scattered(std::span<const RasterWindow> parts);

/// Reads the union of the parts, of which there is at least one, and closes the file; if they are scattered, reads
/// nothing and returns false: the caller reads one after the other.
bool read_together(MapInput& input, std::span<const RasterWindow> parts);

/// Returns the rows that the horizons of nodes in `rows` depend on, on whatever plane. `distance`, in metres, may be
/// infinite.
RasterWindow rows_around(MapInput& input, const RasterWindow& rows, double distance);

/// Throws Error "observer: X,Y is on nodata ..." if the height of an end counts from ground that does not exist. The
/// part that was read must contain the end.
void require_ground(const MapInput& input, const SightEnd& end, std::string_view who);

/// Converts a position in the raster to one in the part that was read, and back: exactly, for positions in the part.
SightEnd in_part(const MapInput& input, SightEnd end);
Node in_part(const MapInput& input, const Node& node);

}  // namespace scarp::cli
