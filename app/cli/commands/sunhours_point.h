// SPDX-License-Identifier: MIT
// `scarp sunhours` at a point: a table of days, or a picture of the sun's path over the skyline.
#pragma once

#include <optional>
#include <string>

#include "app/cli/options/horizon_options.h"
#include "app/cli/picture/map_run.h"

namespace scarp::cli {

struct SunHoursOptions : MapCommand {
  std::string from, to, offset, sum = "range", at, size;
  std::optional<int> step;
  bool refraction = false, first_last = false, energy = false;
  double linke = 3, albedo = 0.2;
  HorizonInput horizon;

  /// Minutes between positions of the sun.
  int minutes() const { return step.value_or(at.empty() ? 30 : 1); }
};

/// Writes the days of --at as CSV to the output or to standard output, or draws the sun's path. Throws Error;
/// Interrupted.
void write_point_sun(SunHoursOptions options);

}  // namespace scarp::cli
