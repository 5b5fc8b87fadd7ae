// SPDX-License-Identifier: MIT
#include "app/cli/commands/sunhours_point.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
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

// A point with the ground that was read, and its local time.
struct PointOfSun {
  HorizonPlace place;
  HorizonSettings horizon;
  SunPlaceSettings settings;
  int offset = 0;  // minutes
};

PlaceTable points_of(const SunHoursOptions& options) {
  if (!options.points.path.empty()) return options.points.read(PlaceKind::points);
  PlaceTable table;
  table.rows.push_back({typed_height_place(options.at, "--at"), {}, 0});
  return table;
}

// When the samples around the place have been read.
PointOfSun point_of(const SunHoursOptions& options, MapInput& input, const HorizonPlace& place, int offset) {
  PointOfSun point{place, horizon_settings(options.horizon, input), {}, offset};
  point.horizon.eye_height = place.eye_height;
  const dvec2 at = place.at;
  const auto lonlat = input.lonlat_of(at.x, at.y);
  if (!lonlat)
    throw Error(fmt::format("{}: longitude and latitude are outside the domain of the raster's CRS", place.what));
  const HeightField field = input.field_at(at.x, at.y, point.horizon.max_distance);
  const SightEnd local = in_part(input, SightEnd{at.x, at.y});
  const auto height = SightGround(field).height_at(local.col, local.row);
  if (!height) throw Error(fmt::format("{}: the point is over a hole", place.what));
  SunPlaceSettings& settings = point.settings;
  settings.col = local.col, settings.row = local.row;
  settings.place = {lonlat->x / kDegreesPerRadian, lonlat->y / kDegreesPerRadian, *height};
  settings.grid_north = input.north_at(at.x, at.y);
  settings.refraction = options.refraction;
  settings.horizon = point.horizon;
  settings.step = options.minutes();
  settings.energy = options.energy, settings.linke = options.linke, settings.albedo = options.albedo;
  settings.transmittance = options.transmittance;
  return point;
}

// Minutes: --utc-offset, or the offset for the longitude of the first point that is in the raster.
int offset_at(const SunHoursOptions& options, MapInput& input, const PlaceTable& table) {
  const std::optional<int> typed = offset_of(options.offset);
  const dvec2 centre = input.centre();
  if (!input.lonlat_of(centre.x, centre.y))
    throw Error(fmt::format("{}: the sun's position needs a raster with a CRS (give --crs)", input.path()));
  if (typed) return *typed;
  RowStatus status(table, true);
  std::optional<dvec2> lonlat;
  for (std::size_t row = 0; row < table.rows.size() && !lonlat; ++row)
    status.attempt(row, RowStatus::kOutside, [&] {
      const dvec2 at = horizon_position(input, table, row);
      lonlat = input.lonlat_of(at.x, at.y);
    });
  if (!lonlat) lonlat = input.lonlat_of(centre.x, centre.y);  // all points are refused later
  const int offset = offset_by_longitude(lonlat->x);
  input.notes.push_back(fmt::format("times are UTC{}, chosen from the longitude{} (--utc-offset)", offset_text(offset),
                                    table.rows.size() > 1 ? " of the first point" : ""));
  return offset;
}

// "06:05:09" of hours since midnight; empty without.
std::string time_text(std::optional<double> hours) {
  if (!hours) return "";
  constexpr int kMinute = 60, kHour = 3600;
  const auto seconds = static_cast<int>(std::lround(*hours * kHour));
  return fmt::format("{:02}:{:02}:{:02}", seconds / kHour, seconds / kMinute % 60, seconds % 60);
}

constexpr const char* kEnergyColumns = ",energy,beam,diffuse,reflected";

// The periods of a point, each in a line that starts with `before` and ends with `behind`.
std::string lines_of(const SunPlace& sun, const PointOfSun& point, const std::vector<SunPeriod>& periods, bool by_day,
                     const std::string& before, std::string_view behind, const Progress& progress) {
  const chrono::sys_days from = periods.front().first;
  std::vector<SunDay> days(static_cast<std::size_t>((periods.back().last - from).count() + 1));
  parallel_for(
      static_cast<std::int64_t>(days.size()), 1,
      [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
          const chrono::sys_days day = from + chrono::days(i);
          days[static_cast<std::size_t>(i)] = sun.day(midnight_of(day, point.offset), day_of_year(day));
        }
      },
      progress);
  std::string text;
  for (const SunPeriod& period : periods) {
    SunDay sum;
    for (auto i = (period.first - from).count(); i <= (period.last - from).count(); ++i) {
      const SunDay& day = days[static_cast<std::size_t>(i)];
      sum.first = day.first, sum.last = day.last;
      sum.hours += day.hours, sum.beam += day.beam, sum.diffuse += day.diffuse, sum.reflected += day.reflected;
    }
    text += before + period.name;
    if (by_day) text += fmt::format(",{},{}", time_text(sum.first), time_text(sum.last));
    text += fmt::format(",{:.4f}", sum.hours);
    if (point.settings.energy)
      text += fmt::format(",{:.5f},{:.5f},{:.5f},{:.5f}", sum.beam + sum.diffuse + sum.reflected, sum.beam, sum.diffuse,
                          sum.reflected);
    text += fmt::format("{}\n", behind);
  }
  return text;
}

std::string table_of(const SunHoursOptions& options, MapInput& input, const PlaceTable& table, int offset) {
  const bool skips = options.points.skip_bad, numbered = !options.points.path.empty();
  const bool by_day = options.period() == "day";
  RowStatus status(table, skips);
  const std::vector<SunPeriod> periods = periods_of(options);
  const auto before = [&](std::size_t row) {
    return numbered ? carried_texts(table, row) + fmt::format("{},", row + 1) : std::string();
  };
  std::vector<std::string> lines(table.rows.size());
  visit_places(input, table, horizon_settings(options.horizon, input), status, terminal_progress("sun"),
               [&](std::size_t row, const HorizonPlace& place, const Progress& progress) {
                 const PointOfSun point = point_of(options, input, place, offset);
                 const SunPlace sun(input.field_at(place.at.x, place.at.y, point.horizon.max_distance), point.settings);
                 lines[row] = lines_of(sun, point, periods, by_day, before(row), skips ? ",ok" : "", progress);
               });
  const std::string columns =
      fmt::format("{}{}", by_day ? ",first_sun,last_sun,hours" : ",hours", options.energy ? kEnergyColumns : "");
  std::string text = numbered ? carried_names(table) + "point," : "";
  text += fmt::format("{}{}{}\n", by_day ? "date" : "period", columns, skips ? ",status" : "");
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (status.good(row)) {
      text += lines[row];
    } else {
      text += before(row) + std::string(static_cast<std::size_t>(std::count(columns.begin(), columns.end(), ',')), ',');
      text += fmt::format(",{}\n", status.of(row));
    }
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

std::vector<SunPeriod> periods_of(const SunHoursOptions& options) {
  const auto [from, to] = days_of(options.from, options.to);
  const std::string kind = options.period();
  if (kind == "range") return {{dates_text(from, to), from, to}};
  std::vector<SunPeriod> periods;
  for (chrono::sys_days day = from; day <= to; day += chrono::days(1)) {
    const std::string name = kind == "day" ? date_text(day) : date_text(day).substr(0, 7);
    if (periods.empty() || periods.back().name != name) periods.push_back({name, day, day});
    periods.back().last = day;
  }
  return periods;
}

void write_point_sun(SunHoursOptions options) {
  if (options.output == "-") options.output.clear();
  const std::vector<SunPeriod> periods = periods_of(options);
  offset_of(options.offset);  // throws
  require_table_or_figure(options.output, " with --at or --points");
  keep_inputs(options.output, options.typed);
  const ThreadLimit limit(options.threads);
  const PlaceTable table = points_of(options);
  if (is_figure(options.output) && table.rows.size() > 1)
    throw Error(fmt::format("output '{}': a figure shows one point, not {}", options.output, table.rows.size()));
  MapInput input(options);
  input.notes.insert(input.notes.end(), table.notes.begin(), table.notes.end());
  keep_inputs(options.output, input.files());
  if (!options.output.empty()) const ReplaceFile writable(options.output);
  const int offset = offset_at(options, input, table);
  if (is_figure(options.output)) {
    RowStatus status(table, false);
    const HorizonSettings settings = horizon_settings(options.horizon, input);
    return visit_places(input, table, settings, status, {},
                        [&](std::size_t, const HorizonPlace& place, const Progress&) {
                          const PointOfSun point = point_of(options, input, place, offset);
                          const HeightField field = input.field_at(place.at.x, place.at.y, point.horizon.max_distance);
                          draw_sun(options, input, SunPlace(field, point.settings), point, periods.front().first);
                        });
  }
  const std::string text = table_of(options, input, table, offset);
  if (options.output.empty()) {
    fmt::print("{}", text);
    return print_notes(input.notes);
  }
  write_whole_file(options.output, text);
  print_notes(input.notes);
  const auto days = (periods.back().last - periods.front().first).count() + 1;
  fmt::print("{}: {}{} days; {}\n", options.output,
             options.points.path.empty() ? "" : fmt::format("{} points, ", table.rows.size()), days,
             input.curvature_text());
}

}  // namespace scarp::cli
