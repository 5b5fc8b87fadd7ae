// SPDX-License-Identifier: MIT
// The part of a large raster that rays with an end need, so that `scarp cast` reads only this part.
//
// Rays over a part have other local coordinates than over the whole raster, so positions and t differ by rounding: by
// about 2^-52 of the coordinates. Other subcommands count in whole cells and have no such difference (map_part.h).
#pragma once

#include <optional>
#include <span>

#include "app/cli/options/open_input.h"
#include "app/cli/options/places.h"
#include "scarp/source/table/ray_table.h"

namespace scarp::cli {

/// Rays over a part of a raster.
struct CastPart {
  RasterWindow part;   ///< of the raster
  PlaceRaster raster;  ///< the whole raster, which defines coordinates
  dvec3 origin{0.0};   ///< the part's south-west sample in local coordinates of the whole raster
};

/// Returns the part around all rays of the table, or nullopt if they need the whole raster, or it is small enough to be
/// read at once. Opens the raster without reading samples. Throws Error as open_input() and
/// placed_rays() do.
std::optional<CastPart> part_of_rays(const InputOptions& options, RayTable& table, const std::string& coordinates,
                                     bool skip_bad);

}  // namespace scarp::cli
