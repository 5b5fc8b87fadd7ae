// SPDX-License-Identifier: MIT
// `scarp horizon` at points: a table of the horizon in each azimuth, or a figure of the skyline.
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
  std::string labels, size;
  bool clamp = false, distance = false, farthest = false, pack = false;

  bool at_points() const { return !at.empty() || !points.path.empty(); }
  /// Degrees clockwise from true north.
  std::vector<double> all_azimuths() const;
};

/// Writes the horizons of --at or --points as CSV to the output or to standard output, or draws that of one point.
/// Throws Error; Interrupted.
void write_point_horizons(HorizonOptions options);

}  // namespace scarp::cli
