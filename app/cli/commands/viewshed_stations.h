// SPDX-License-Identifier: MIT
// Observers along lines and over polygons, for `scarp viewshed --observer-spacing`.
#pragma once

#include "app/cli/options/map_input.h"
#include "scarp/source/table/place_table.h"

namespace scarp::cli {

/// Returns observers every `spacing` metres along the lines of a table, and on a square grid inside its polygons; at
/// least one in each. One on a sample that already has an observer of the same polygon, or the one before on a line, is
/// left out. Observers keep the other columns. If `skip`, lines and polygons that leave the raster become bad rows.
PlaceTable stations_on(MapInput& input, const PlaceTable& shapes, double spacing, bool skip);

}  // namespace scarp::cli
