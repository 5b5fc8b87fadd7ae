// SPDX-License-Identifier: MIT
// `scarp sunhours` at points: a table of days, or a picture of the sun's path over the skyline.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/horizon_options.h"
#include "app/cli/options/place_file.h"
#include "app/cli/picture/map_run.h"

namespace scarp::cli {

struct SunHoursOptions : MapCommand {
  std::string from, to, offset, sum, at, size;
  PlaceFile points;
  std::optional<int> step;
  bool refraction = false, first_last = false, energy = false, per_cell = false, masks = false;
  double linke = 3, albedo = 0.2;
  std::optional<double> transmittance;
  HorizonInput horizon;

  bool at_points() const { return !at.empty() || !points.path.empty(); }
  /// Minutes between positions of the sun.
  int minutes() const { return step.value_or(at_points() ? 1 : 30); }
  /// "day", "month" or "range".
  std::string period() const { return !sum.empty() ? sum : at_points() ? "day" : "range"; }
};

/// Days that are summed.
struct SunPeriod {
  std::string name;
  std::chrono::sys_days first, last;
};
std::vector<SunPeriod> periods_of(const SunHoursOptions& options);

/// Writes the periods of --at or --points as CSV to the output or to standard output, or draws the sun's path over the
/// skyline of one point. Throws Error; Interrupted.
void write_point_sun(SunHoursOptions options);

}  // namespace scarp::cli
