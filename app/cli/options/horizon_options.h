// SPDX-License-Identifier: MIT
// What subcommands about horizons share: the eye, how far ground counts, and the engine.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/cli/options/map_input.h"
#include "scarp/analysis/horizon.h"
#include "scarp/analysis/map_part.h"

namespace scarp::cli {

struct HorizonInput {
  double eye_height = 0;  ///< metres
  std::optional<double> max_distance;
  std::string engine = "exact";
  double memory = std::numeric_limits<double>::infinity();  ///< HorizonSettings::memory

  bool swept() const { return engine == "sweep"; }
  /// Estimated time of one horizon of one node.
  double node_azimuth_s() const { return swept() ? 1e-8 : 4e-8; }
  /// Metres; infinite without a limit.
  double reach() const { return max_distance.value_or(std::numeric_limits<double>::infinity()); }
};

/// Declares --observer-height, --max-distance, --engine and --cc. `excludes`: options with which the output is not a
/// map.
void add_horizon_options(Command& command, HorizonInput& horizon, std::optional<double>& curvature,
                         const std::vector<std::string>& excludes = {});

/// Rows that a strip of MapRecipe should have, for the samples that were read: horizons of ground beyond the memory are
/// found by strips along each azimuth, which few rows would not use.
int rows_of_strip(const HorizonInput& horizon, const MapInput& input);

HorizonSettings horizon_settings(const HorizonInput& horizon, const MapInput& input);

/// "exact horizons", or what else the engine finds.
std::string horizon_method(const HorizonInput& horizon);

/// How far a swept map is off on a sample of its nodes, "; angles off by ..."; empty for the engine exact. `azimuths`
/// in radians from true north.
std::string horizon_errors_text(const HorizonInput& horizon, MapInput& input, std::span<const double> azimuths,
                                const RowBand& rows);

/// OBSERVER_HEIGHT, MAX_DISTANCE, ENGINE, CURVATURE_COEFFICIENT and DIAMETER.
Metadata horizon_metadata(const HorizonInput& horizon, const MapInput& input);

}  // namespace scarp::cli
