// SPDX-License-Identifier: MIT
// What subcommands about horizons share: the eye, how far ground counts, and the plane of the whole raster.
#pragma once

#include <limits>
#include <optional>

#include "app/cli/options/map_input.h"
#include "scarp/analysis/horizon.h"

namespace scarp::cli {

struct HorizonInput {
  double eye_height = 0;  ///< metres
  std::optional<double> max_distance;

  /// Metres; infinite without a limit.
  double reach() const { return max_distance.value_or(std::numeric_limits<double>::infinity()); }
};

/// Declares --observer-height, --max-distance and --cc.
void add_horizon_options(Command& command, HorizonInput& horizon, std::optional<double>& curvature);

HorizonSettings horizon_settings(const HorizonInput& horizon, const MapInput& input);

/// The field on the plane of its centre, and the azimuth of grid north there in radians. Throws Error if the plane
/// displaces samples by more than --plane-error.
struct HorizonPlane {
  HeightField field;
  double grid_north;
};
HorizonPlane horizon_plane(MapInput& input);

/// OBSERVER_HEIGHT, MAX_DISTANCE, CURVATURE_COEFFICIENT and DIAMETER.
Metadata horizon_metadata(const HorizonInput& horizon, const MapInput& input);

/// Estimated time of one horizon of one node.
inline constexpr double kNodeAzimuth_s = 4e-8;

}  // namespace scarp::cli
