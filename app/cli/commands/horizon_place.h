// SPDX-License-Identifier: MIT
// Points whose horizons are computed one by one, direction by direction.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "app/cli/options/horizon_options.h"
#include "app/cli/options/place_file.h"
#include "scarp/source/raster/opened_raster.h"
#include "scarp/source/table/place_table.h"

namespace scarp::cli {

struct HorizonPlace {
  std::string what;  ///< for messages
  dvec2 at;          ///< columns and rows of the raster
  double eye_height = 0;
  RasterWindow part;  ///< the samples that its horizon depends on
};

/// Columns and rows of the place of a row of the table. Throws Error naming the row, or --at, if it is outside.
dvec2 horizon_position(MapInput& input, const PlaceTable& table, std::size_t row);

/// The place of a row at that position, with its own height of the eye or that of the settings. Throws Error naming the
/// row, or --at, for a negative height.
HorizonPlace horizon_place(MapInput& input, const PlaceTable& table, std::size_t row, const dvec2& at,
                           const HorizonSettings& settings);

/// Calls use(row, place, progress) for the good rows of a table, in order, when the samples have been read that the
/// horizon of the place depends on. Throws Error, from `use` too, unless `status` skips bad rows; Interrupted.
void visit_places(MapInput& input, const PlaceTable& table, const HorizonSettings& settings, RowStatus& status,
                  const Progress& progress,
                  const std::function<void(std::size_t row, const HorizonPlace& place, const Progress& progress)>& use);

/// The names of the table's other columns, and their texts in a row, as CSV with a comma at the end; empty without.
std::string carried_names(const PlaceTable& table);
std::string carried_texts(const PlaceTable& table, std::size_t row);

/// The horizons of a place, over the part that was read, for azimuths in degrees clockwise from true north. Runs on all
/// threads. Throws Error if the place is over a hole; Interrupted.
std::vector<HorizonView> horizons_at(MapInput& input, const HorizonPlace& place, const std::vector<double>& azimuths,
                                     HorizonSettings settings, const Progress& progress);

}  // namespace scarp::cli
