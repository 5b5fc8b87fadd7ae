// SPDX-License-Identifier: MIT
// The sun over the window's raster at a date and time: that of `scarp shadow --time`, at the raster's centre.
#pragma once

#include <chrono>
#include <string>

#include "app/cli/options/map_input.h"
#include "app/viewer/opening.h"
#include "scarp/analysis/sun_position.h"

namespace scarp::viewer {

class SunClock {
 public:
  /// "2026-06-21".
  static std::string day_text(std::chrono::sys_days day);
  /// Throws Error for another form, and for years outside 1900 to 2100.
  static std::chrono::sys_days day_of(const std::string& text);

  /// Opens the header of the raster. Throws Error for inputs other than rasters with a CRS, and in a build without
  /// ERFA.
  explicit SunClock(const Opening& opening);

  /// "2026-06-21T09:30+02:00": `minutes` after midnight, 0 to 1440, in whole hours of time by longitude.
  std::string time_text(std::chrono::sys_days day, int minutes) const;
  SunPosition at(std::chrono::sys_days day, int minutes) const;
  /// The command that writes the shadows of that time to `output`.
  std::string command(std::chrono::sys_days day, int minutes, const std::string& output) const;

 private:
  std::string words_;  // of the input, for commands
  EarthPlace place_{};
  int offset_ = 0;  // minutes east of UTC
};

/// The time of day at which the sun shines on the window, and its course.
struct SunTime {
  std::chrono::sys_days day{};
  double minutes = 12 * 60;  ///< after midnight, 0 to 1440
  bool plays = false;

  /// Moves on while it plays: an hour per second, from midnight to midnight.
  void advance(double seconds);
};

}  // namespace scarp::viewer
