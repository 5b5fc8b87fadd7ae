// SPDX-License-Identifier: MIT
// `scarp horizon` at points: a table of the horizon in each azimuth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/horizon_options.h"
#include "app/cli/options/place_file.h"
#include "app/cli/picture/map_run.h"

namespace scarp::cli {

struct HorizonOptions : MapCommand {
  std::optional<int> azimuths;
  double first_azimuth = 0;
  HorizonInput horizon;
  std::vector<std::string> at;
  PlaceFile points;
  bool clamp = false, distance = false;

  bool at_points() const { return !at.empty() || !points.path.empty(); }
  /// Degrees clockwise from true north.
  std::vector<double> all_azimuths() const;
};

/// Writes the horizons of --at or --points as CSV to the output, or to standard output. Throws Error; Interrupted.
void write_point_horizons(HorizonOptions options);

}  // namespace scarp::cli
