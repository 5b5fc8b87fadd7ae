// SPDX-License-Identifier: MIT
// `scarp sunhours`: maps how long the sun shines on each pixel of an elevation model.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/options/horizon_options.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/picture/map_run.h"
#include "scarp/analysis/sun_hours.h"
#include "scarp/analysis/sun_position.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

namespace chrono = std::chrono;

constexpr int kMinutesPerDay = 24 * 60;
constexpr const char* kSunHoursMethod =
    "exact horizons towards the centre of the sun; ground linear at crossings of grid lines (scarp sunhours)";
constexpr const char* kSunHoursFooter =
    R"(Pixels: hours of direct sun, one band per period. With --first-last, two more bands per day: the
time of day, in hours, of the middle of the first and the last step with sun (nodata: none).
The sun of each step is that in its middle, at the centre of the raster.)";

struct SunHoursOptions : MapCommand {
  std::string from, to, offset, sum = "range";
  int step = 30;  // minutes
  bool refraction = false, first_last = false;
  HorizonInput horizon;
};

chrono::sys_days day_of(const std::string& text, std::string_view option) {
  int year = 0;
  unsigned month = 0, day = 0;
  char end = 0;
  const bool read = std::sscanf(text.c_str(), "%4d-%2u-%2u%c", &year, &month, &day, &end) == 3;
  const chrono::year_month_day date{chrono::year(year), chrono::month(month), chrono::day(day)};
  if (!read || text.size() != 10 || !date.ok())
    throw Error(fmt::format("{} '{}': expected a date, for example 2026-06-21", option, text));
  return date;
}

// Minutes east of UTC.
int offset_of(const std::string& text) {
  char sign = 0, end = 0;
  int hours = 0, minutes = 0;
  const int read = std::sscanf(text.c_str(), "%c%2d:%2d%c", &sign, &hours, &minutes, &end);
  if (read != 3 || (sign != '+' && sign != '-') || hours < 0 || hours > 14 || minutes < 0 || minutes > 59)
    throw Error(fmt::format("--utc-offset '{}': expected +HH:MM or -HH:MM, for example -04:00", text));
  return (sign == '-' ? -1 : 1) * (60 * hours + minutes);
}

std::string offset_text(int minutes) {
  return fmt::format("{}{:02}:{:02}", minutes < 0 ? '-' : '+', std::abs(minutes) / 60, std::abs(minutes) % 60);
}

std::string date_text(chrono::sys_days day) {
  const chrono::year_month_day date(day);
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                     static_cast<unsigned>(date.day()));
}

// Days that are summed in one band.
struct Period {
  std::string name;
  chrono::sys_days first, last;
};

std::vector<Period> periods_of(const SunHoursOptions& options, chrono::sys_days from, chrono::sys_days to) {
  if (options.sum == "range") {
    const std::string name = from == to ? date_text(from) : date_text(from) + " to " + date_text(to);
    return {{name, from, to}};
  }
  std::vector<Period> periods;
  for (chrono::sys_days day = from; day <= to; day += chrono::days(1)) {
    const std::string name = options.sum == "day" ? date_text(day) : date_text(day).substr(0, 7);
    if (periods.empty() || periods.back().name != name) periods.push_back({name, day, day});
    periods.back().last = day;
  }
  return periods;
}

// The moments of a period when the sun is up, and the time of day in the middle of each, in hours.
struct Moments {
  std::vector<SunMoment> moments;
  std::vector<float> time;
};

Moments moments_of(const Period& period, const SunHoursOptions& options, const EarthPlace& place, int offset,
                   double grid_north) {
  Moments up;
  for (chrono::sys_days day = period.first; day <= period.last; day += chrono::days(1)) {
    for (int minute = 0; minute < kMinutesPerDay; minute += options.step) {
      const double length = std::min(options.step, kMinutesPerDay - minute), middle = minute + 0.5 * length;
      const auto seconds = static_cast<int>(std::lround(60 * middle));
      const std::string time = fmt::format("{}T{:02}:{:02}:{:02}{}", date_text(day), seconds / 3600, seconds / 60 % 60,
                                           seconds % 60, offset_text(offset));
      const SunPosition sun = sun_position(parse_time(time), place, options.refraction);
      if (!(sun.altitude > 0)) continue;
      up.moments.push_back({{sun.azimuth - grid_north, sun.altitude}, length / 60});
      up.time.push_back(static_cast<float>(middle / 60));
    }
  }
  return up;
}

// The bands of a period.
void add_bands(std::vector<ComputedBand>& bands, const std::string& name, SunHours found, const Moments& up,
               bool first_last) {
  bands.push_back(number_band("hours of sun " + name, "h", std::move(found.hours)));
  if (!first_last) return;
  const auto time_of = [&](std::int32_t moment) {
    return moment < 0 ? std::numeric_limits<float>::quiet_NaN() : up.time[static_cast<std::size_t>(moment)];
  };
  for (const auto& [what, moments] : {std::pair("first sun ", &found.first), std::pair("last sun ", &found.last)}) {
    std::vector<float> times(moments->size());
    std::transform(moments->begin(), moments->end(), times.begin(), time_of);
    bands.push_back(number_band(what + name, "h", std::move(times)));
  }
}

void run(SunHoursOptions options, const Command& command) {
  if (options.from.empty()) throw WrongUsage("--date DATE is required (see 'scarp sunhours --help')");
  const chrono::sys_days from = day_of(options.from, "--date");
  const chrono::sys_days to = options.to.empty() ? from : day_of(options.to, "--to");
  if (to < from) throw Error(fmt::format("--to {}: is before --date {}", options.to, options.from));
  const std::vector<Period> periods = periods_of(options, from, to);
  MapRun run(options, command, "Float32");
  MapInput& input = run.input();
  const auto lonlat = input.lonlat_of(input.centre().x, input.centre().y);
  if (!lonlat) throw Error(fmt::format("{}: the sun's position needs a raster with a CRS (give --crs)", input.path()));
  // Local time by longitude: noon is within half an hour of the sun's highest position.
  const int offset =
      options.offset.empty() ? static_cast<int>(std::lround(lonlat->x / 15)) * 60 : offset_of(options.offset);
  if (options.offset.empty())
    input.notes.push_back(fmt::format("days are those of UTC{}, by the longitude (--utc-offset)", offset_text(offset)));
  const double bands_per_period = options.first_last ? 3 : 1, days = static_cast<double>((to - from).count() + 1);
  if (!run.begin(29 + 4 * bands_per_period * static_cast<double>(periods.size()),
                 days * kMinutesPerDay / options.step / 2 * kNodeAzimuth_s))
    return;
  const EarthPlace place{lonlat->x / kDegreesPerRadian, lonlat->y / kDegreesPerRadian,
                         0.5 * (input.field().min_height() + input.field().max_height())};
  Metadata metadata = horizon_metadata(options.horizon, input);
  metadata.emplace_back("STEP", fmt::format("{} minutes", options.step));
  metadata.emplace_back("UTC_OFFSET", offset_text(offset));
  float longest = 0;
  const auto compute = [&](const RowBand& rows, const Progress& progress) {
    const HorizonPlane plane = horizon_plane(input);
    const Horizons horizons(plane.field, horizon_settings(options.horizon, input), progress);
    std::vector<ComputedBand> bands;
    for (const Period& period : periods) {
      const Moments up = moments_of(period, options, place, offset, plane.grid_north);
      SunHours found = sun_hours(horizons, up.moments, rows.first, rows.last, progress);
      for (const float hours : found.hours) longest = std::fmax(longest, hours);
      add_bands(bands, period.name, std::move(found), up, options.first_last);
    }
    return bands;
  };
  const auto summary = [&] {
    return fmt::format("{} {}, at most {:.4g} hours of sun", periods.size(), periods.size() == 1 ? "period" : "periods",
                       static_cast<double>(longest));
  };
  run.write({kSunHoursMethod, metadata, "viridis", compute, summary});
}

}  // namespace

void add_sunhours(Program& program) {
  Command& command = program.add("sunhours", "Map how long the sun shines on an elevation model");
  const auto options = std::make_shared<SunHoursOptions>();
  SunHoursOptions& o = *options;
  command.add(
      &o.from,
      {.names = "--date", .value = "DATE", .help = "day, or the first of several, as 2026-06-21", .common = true});
  command.add(&o.to,
              {.names = "--to", .value = "DATE", .help = "last day", .fallback = "that of --date", .common = true});
  command.add(&o.step, {.names = "--step",
                        .value = "MIN",
                        .help = "minutes between positions of the sun",
                        .range = {1, kMinutesPerDay},
                        .common = true});
  command.add(&o.sum, {.names = "--sum",
                       .value = "PERIOD",
                       .help = "period of a band",
                       .choices = {"day", "month", "range"},
                       .closed = true,
                       .common = true});
  command.add(&o.first_last, {.names = "--first-last",
                              .help = "bands of the time of the first and the last sun of a day, too",
                              .common = true,
                              .rules = {needs("--sum day, or a single day",
                                              [&o] { return o.sum == "day" || o.to.empty() || o.to == o.from; })}});
  command.add(&o.offset, {.names = "--utc-offset",
                          .value = "+HH:MM",
                          .help = "local time, in which days begin at midnight",
                          .fallback = "by the longitude",
                          .common = true});
  command.add(
      &o.refraction,
      {.names = "--refraction", .help = "raise the sun by the refraction of a standard atmosphere", .common = true});
  add_output_option(command, o.output, "raster to write", "tif tiff img asc");
  add_horizon_options(command, o.horizon, o.curvature);
  add_map_command(command, o, [options, &command] { run(*options, command); });
  command.footer(kSunHoursFooter);
  command.example("scarp sunhours dem.tif --date 2026-06-21 -o hours.tif");
  command.example("scarp sunhours dem.tif --date 2026-01-01 --to 2026-12-31 --sum month --step 60 -o months.tif");
}

}  // namespace scarp::cli
