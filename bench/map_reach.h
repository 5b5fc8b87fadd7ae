// SPDX-License-Identifier: MIT
// What `scarp` reads of rasters far larger than a question.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "bench/maps_options.h"

namespace scarp::bench {

/// Runs subcommands that need a small part of a raster of 40,000 x 40,000 samples, a mosaic of one tile, as whole
/// processes, in turn with gdal_viewshed. Returns a row for each, as README.md describes; none if `scarp` is not among
/// options.programs. Throws Error if a program fails.
std::vector<nlohmann::ordered_json> measure_reach(const MapsOptions& options);

}  // namespace scarp::bench
