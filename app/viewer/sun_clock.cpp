// SPDX-License-Identifier: MIT
#include "app/viewer/sun_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/cli/options/sun_dates.h"
#include "app/viewer/map_command.h"
#include "scarp/base/error.h"

namespace scarp::viewer {
namespace {

constexpr int kMinutesPerHour = 60;

}  // namespace

void SunTime::advance(double seconds) {
  if (plays) minutes = std::fmod(minutes + kMinutesPerHour * seconds, cli::kMinutesPerDay);
}

#ifdef SCARP_ERFA

std::string SunClock::day_text(std::chrono::sys_days day) { return cli::date_text(day); }
std::chrono::sys_days SunClock::day_of(const std::string& text) { return cli::days_of(text, "").from; }

SunClock::SunClock(const Opening& opening) : words_(raster_words(opening.command())) {
  if (opening.kind != cli::InputKind::terrain) throw Error("the sun of a date needs a raster with a CRS");
  cli::MapOptions options;
  options.inputs = opening.options->inputs;
  options.raster = opening.options->raster;
  cli::MapInput input(options);
  const dvec2 centre = input.centre();
  const auto at = input.lonlat_of(centre.x, centre.y);
  if (!at) throw Error("the sun of a date needs a raster with a CRS (--crs)");
  place_ = {at->x / cli::kDegreesPerRadian, at->y / cli::kDegreesPerRadian, input.height_at_centre().value_or(0)};
  offset_ = cli::offset_by_longitude(at->x);
}

std::string SunClock::time_text(std::chrono::sys_days day, int minutes) const {
  const int of_day = std::min(minutes, cli::kMinutesPerDay - 1);
  return fmt::format("{}T{:02}:{:02}{}", cli::date_text(day), of_day / kMinutesPerHour, of_day % kMinutesPerHour,
                     cli::offset_text(offset_));
}

SunPosition SunClock::at(std::chrono::sys_days day, int minutes) const {
  return sun_position(parse_time(time_text(day, minutes)), place_);
}

#else

std::string SunClock::day_text(std::chrono::sys_days) { return {}; }
std::chrono::sys_days SunClock::day_of(const std::string&) { return {}; }

SunClock::SunClock(const Opening&) { throw Error("this build does not compute the sun's position (SCARP_ERFA=OFF)"); }

std::string SunClock::time_text(std::chrono::sys_days, int) const { return {}; }
SunPosition SunClock::at(std::chrono::sys_days, int) const { return {}; }

#endif

std::string SunClock::command(std::chrono::sys_days day, int minutes, const std::string& output) const {
  return fmt::format("scarp shadow{} --time {} -o {}", words_, time_text(day, minutes), output);
}

}  // namespace scarp::viewer
