// SPDX-License-Identifier: MIT
#include "app/cli/commands/sunhours_point.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "app/cli/commands/skyline.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/map_part.h"
#include "app/cli/options/plot_options.h"
#include "app/cli/options/sight_options.h"
#include "app/cli/options/sun_dates.h"
#include "app/cli/progress.h"
#include "scarp/analysis/sun_day.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/base/replace_file.h"
#include "scarp/source/whole_file.h"

namespace scarp::cli {
namespace {

namespace chrono = std::chrono;

// The point of --at with the ground that was read, and its local time.
struct PointOfSun {
  HorizonPlace place;
  HorizonSettings horizon;
  SunPlaceSettings settings;
  int offset = 0;  // minutes
};

PointOfSun point_of(const SunHoursOptions& options, MapInput& input, std::optional<int> typed_offset) {
  PlaceTable table;
  table.rows.push_back({typed_height_place(options.at, "--at"), {}, 0});
  PointOfSun point;
  point.horizon = horizon_settings(options.horizon, input);
  point.place = horizon_place(input, table, 0, horizon_position(input, table, 0), point.horizon);
  point.horizon.eye_height = point.place.eye_height;
  const dvec2 at = point.place.at;
  const auto lonlat = input.lonlat_of(at.x, at.y);
  if (!lonlat) throw Error(fmt::format("{}: the sun's position needs a raster with a CRS (give --crs)", input.path()));
  point.offset = typed_offset.value_or(offset_by_longitude(lonlat->x));
  if (!typed_offset)
    input.notes.push_back(
        fmt::format("times are UTC{}, chosen from the longitude (--utc-offset)", offset_text(point.offset)));
  input.read(point.place.part, terminal_progress("read"));
  input.close();
  const HeightField field = input.field_at(at.x, at.y, point.horizon.max_distance);
  const SightEnd local = in_part(input, SightEnd{at.x, at.y});
  const auto height = SightGround(field).height_at(local.col, local.row);
  if (!height) throw Error("--at: the point is over a hole");
  SunPlaceSettings& settings = point.settings;
  settings.col = local.col, settings.row = local.row;
  settings.place = {lonlat->x / kDegreesPerRadian, lonlat->y / kDegreesPerRadian, *height};
  settings.grid_north = input.grid_north_at(at.x, at.y, point.horizon.max_distance);
  settings.refraction = options.refraction;
  settings.horizon = point.horizon;
  settings.step = options.minutes();
  settings.energy = options.energy, settings.linke = options.linke, settings.albedo = options.albedo;
  return point;
}

// "06:05:09" of hours since midnight; empty without.
std::string time_text(std::optional<double> hours) {
  if (!hours) return "";
  constexpr int kMinute = 60, kHour = 3600;
  const auto seconds = static_cast<int>(std::lround(*hours * kHour));
  return fmt::format("{:02}:{:02}:{:02}", seconds / kHour, seconds / kMinute % 60, seconds % 60);
}

std::string table_of(const SunPlace& sun, const PointOfSun& point, chrono::sys_days from, chrono::sys_days to) {
  std::vector<SunDay> days(static_cast<std::size_t>((to - from).count() + 1));
  const auto day_at = [&](std::int64_t i) { return from + chrono::days(i); };
  parallel_for(
      static_cast<std::int64_t>(days.size()), 1,
      [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i)
          days[static_cast<std::size_t>(i)] = sun.day(midnight_of(day_at(i), point.offset), day_of_year(day_at(i)));
      },
      terminal_progress("sun"));
  std::string text = "date,first_sun,last_sun,hours";
  text += point.settings.energy ? ",energy,beam,diffuse,reflected\n" : "\n";
  for (std::size_t i = 0; i < days.size(); ++i) {
    const SunDay& day = days[i];
    text += fmt::format("{},{},{},{:.4f}", date_text(day_at(static_cast<std::int64_t>(i))), time_text(day.first),
                        time_text(day.last), day.hours);
    if (point.settings.energy)
      text += fmt::format(",{:.5f},{:.5f},{:.5f},{:.5f}", day.beam + day.diffuse + day.reflected, day.beam, day.diffuse,
                          day.reflected);
    text += '\n';
  }
  return text;
}

#ifdef SCARP_CAIRO

SkyPoint sky_point(const SunPosition& sun) {
  return {sun.azimuth * kDegreesPerRadian, sun.altitude * kDegreesPerRadian};
}

// The path of the sun over a day, with a dot at each full hour.
SunPath path_of(const SunPlace& sun, const PointOfSun& point, chrono::sys_days day, std::string name, bool main) {
  constexpr int kMinutes = 5, kDay = 24 * 60;
  SunPath path{std::move(name), {}, {}, main};
  const UtcTime midnight = midnight_of(day, point.offset);
  for (int minute = 0; minute <= kDay; minute += kMinutes) {
    const SunPosition at = sun.sun(midnight, minute / 60.0);
    path.points.push_back(sky_point(at));
    if (minute % 60 == 0 && minute < kDay && at.altitude > 0)
      path.hours.push_back({sky_point(at), main ? fmt::format("{} h", minute / 60) : ""});
  }
  return path;
}

void draw_sun(const SunHoursOptions& options, MapInput& input, const SunPlace& sun, const PointOfSun& point,
              chrono::sys_days date) {
  constexpr int kWidth = 1200, kHeight = 560, kDirections = 1440;
  const auto [width, height] = plot_size(options.size, kWidth, kHeight);
  // Noon is in the middle.
  SkylineFigure figure =
      skyline_of(input, point.place, point.settings.place.latitude < 0 ? 180 : 0, kDirections, point.horizon);
  const chrono::year year = chrono::year_month_day(date).year();
  const std::pair<chrono::sys_days, const char*> others[] = {
      {year / chrono::June / 21, ""}, {year / chrono::March / 20, " (equinox)"}, {year / chrono::December / 21, ""}};
  for (const auto& [day, what] : others)
    if (day != date) figure.paths.push_back(path_of(sun, point, day, date_text(day) + what, false));
  figure.paths.push_back(path_of(sun, point, date, date_text(date), true));
  const UtcTime midnight = midnight_of(date, point.offset);
  const SunDay day = sun.day(midnight, day_of_year(date));
  // A sun that is up at midnight neither rises nor sets then.
  for (const auto& time : {day.first, day.last})
    if (time && *time > 0 && *time < 24) figure.marks.push_back({sky_point(sun.sun(midnight, *time)), time_text(time)});
  const std::string result = day.first ? fmt::format("first sun {}, last sun {}, {:.2f} hours of sun",
                                                     time_text(day.first), time_text(day.last), day.hours)
                                       : "no sun";
  figure.title = fmt::format("{} UTC{}: {}", date_text(date), offset_text(point.offset), result);
  figure.remark = skyline_title(input, point.place);
  figure.width = width, figure.height = height;
  ReplaceFile file(options.output);
  write_skyline_figure(file, options.output, figure);
  print_notes(input.notes);
  fmt::print("{}: {}; {}\n", options.output, result, input.curvature_text());
}

#else

void draw_sun(const SunHoursOptions&, MapInput&, const SunPlace&, const PointOfSun&, chrono::sys_days) {}

#endif

}  // namespace

void write_point_sun(SunHoursOptions options) {
  if (options.output == "-") options.output.clear();
  const auto [from, to] = days_of(options.from, options.to);
  const std::optional<int> typed_offset = offset_of(options.offset);
  require_table_or_figure(options.output, " with --at");
  keep_inputs(options.output, options.typed);
  const ThreadLimit limit(options.threads);
  MapInput input(options);
  keep_inputs(options.output, input.files());
  if (!options.output.empty()) const ReplaceFile writable(options.output);
  const PointOfSun point = point_of(options, input, typed_offset);
  const dvec2 at = point.place.at;
  const SunPlace sun(input.field_at(at.x, at.y, point.horizon.max_distance), point.settings);
  if (is_figure(options.output)) return draw_sun(options, input, sun, point, from);
  const std::string text = table_of(sun, point, from, to);
  if (options.output.empty()) {
    fmt::print("{}", text);
    return print_notes(input.notes);
  }
  write_whole_file(options.output, text);
  print_notes(input.notes);
  fmt::print("{}: {} days; {}\n", options.output, (to - from).count() + 1, input.curvature_text());
}

}  // namespace scarp::cli
