// SPDX-License-Identifier: MIT
// `scarp sunhours`: maps how long the sun shines on each pixel of an elevation model.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/commands/sunhours_point.h"
#include "app/cli/options/horizon_options.h"
#include "app/cli/options/plot_options.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/options/sun_dates.h"
#include "app/cli/picture/map_run.h"
#include "app/cli/progress.h"
#include "scarp/analysis/sky_view.h"
#include "scarp/analysis/sun_hours.h"
#include "scarp/analysis/sun_position.h"
#include "scarp/base/error.h"
#include "scarp/base/progress_part.h"

namespace scarp::cli {
namespace {

namespace chrono = std::chrono;

constexpr int kSkyAzimuths = 64;  // of the sky view factor
constexpr const char* kSunHoursMethod =
    " towards the centre of the sun; ground linear at crossings of grid lines (scarp sunhours)";
constexpr const char* kSunHoursFooter =
    R"(Pixels: hours of direct sun, one band per period. With --first-last, two more bands per day: the
time of day, in hours, of the middle of the first and the last step with sun (nodata: none).
With --energy, four more bands per period, kWh per square metre of the sloping ground under a clear
sky (ESRA model, Rigollier 2000): the sum, and its parts: beam, diffuse and reflected by the ground.
The sun of each step is that in its middle, at the centre of the raster.
With --at the output is CSV: date, first_sun, last_sun (local time, to the second), hours, and with
--energy energy, beam, diffuse, reflected; or a picture of the sun's path over the skyline.)";

// Days that are summed in one band.
struct Period {
  std::string name;
  chrono::sys_days first, last;
};

std::vector<Period> periods_of(const SunHoursOptions& options, chrono::sys_days from, chrono::sys_days to) {
  if (options.sum == "range") return {{dates_text(from, to), from, to}};
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
    const UtcTime midnight = midnight_of(day, 0);
    const int step = options.minutes();
    for (int minute = 0; minute < kMinutesPerDay; minute += step) {
      const double length = std::min(step, kMinutesPerDay - minute), middle = minute + 0.5 * length;
      const UtcTime time{midnight.day, (middle - offset) / kMinutesPerDay};
      const SunPosition sun = sun_position(time, place, options.refraction);
      if (!(sun.altitude > 0)) continue;
      up.moments.push_back({{sun.azimuth - grid_north, sun.altitude}, length / 60, day_of_year(day)});
      up.time.push_back(static_cast<float>(middle / 60));
    }
  }
  return up;
}

// The bands of a period.
void add_bands(std::vector<ComputedBand>& bands, const std::string& name, SunHours found, const Moments& up,
               const SunHoursOptions& options) {
  bands.push_back(number_band("hours of sun " + name, "h", std::move(found.hours)));
  if (options.energy) {
    SunEnergy& parts = found.energy;
    std::vector<float> sum(parts.beam.size());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = parts.beam[i] + parts.diffuse[i] + parts.reflected[i];
    const auto add = [&](const char* what, std::vector<float> pixels) {
      bands.push_back(number_band(what + name, "kWh/m2", std::move(pixels)));
    };
    add("energy ", std::move(sum)), add("beam ", std::move(parts.beam));
    add("diffuse ", std::move(parts.diffuse)), add("reflected ", std::move(parts.reflected));
  }
  if (!options.first_last) return;
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
  if (!options.at.empty()) return write_point_sun(options);
  if (options.output.empty()) throw WrongUsage("-o FILE is required (see 'scarp sunhours --help')");
  const auto [from, to] = days_of(options.from, options.to);
  const std::vector<Period> periods = periods_of(options, from, to);
  const auto count = static_cast<double>(periods.size()), days = static_cast<double>((to - from).count() + 1);
  const std::optional<int> typed_offset = offset_of(options.offset);
  MapRun run(options, command, "Float32");
  MapInput& input = run.input();
  const auto lonlat = input.lonlat_of(input.centre().x, input.centre().y);
  if (!lonlat) throw Error(fmt::format("{}: the sun's position needs a raster with a CRS (give --crs)", input.path()));
  const int offset = typed_offset.value_or(offset_by_longitude(lonlat->x));
  if (!typed_offset)
    input.notes.push_back(
        fmt::format("days start at midnight UTC{}, chosen from the longitude (--utc-offset)", offset_text(offset)));
  run.set_reach(options.horizon.reach());
  // Not from the samples of a part: all parts have the same sun.
  const double height = options.raster_output.dry_run ? 0 : input.height_at_centre().value_or(0);
  const int bands_per_period = 1 + (options.energy ? 4 : 0) + (options.first_last ? 2 : 0);
  const double suns = days * kMinutesPerDay / options.minutes() / 2 + (options.energy ? kSkyAzimuths : 0);
  if (!run.begin(29 + 4 * count * bands_per_period, suns * options.horizon.node_azimuth_s())) return;
  const EarthPlace place{lonlat->x / kDegreesPerRadian, lonlat->y / kDegreesPerRadian, height};
  Metadata metadata = horizon_metadata(options.horizon, input);
  metadata.emplace_back("STEP", fmt::format("{} minutes", options.minutes()));
  metadata.emplace_back("UTC_OFFSET", offset_text(offset));
  metadata.emplace_back("DATES", dates_text(from, to));
  metadata.emplace_back("REFRACTION", options.refraction ? "standard atmosphere" : "none");
  if (options.energy) {
    metadata.emplace_back("ENERGY", "clear sky of the European Solar Radiation Atlas (Rigollier 2000)");
    metadata.emplace_back("LINKE_TURBIDITY", fmt::format("{:.10g}", options.linke));
    metadata.emplace_back("ALBEDO", fmt::format("{:.10g}", options.albedo));
  }
  double longest = 0;
  std::optional<HorizonPlane> plane;
  std::optional<Horizons> horizons;
  std::optional<SkyView> sky;
  std::vector<double> azimuths;
  const auto compute = [&](const RowBand& rows, const Progress& progress) {
    if (!horizons) {
      plane = horizon_plane(input);
      const HorizonSettings settings = horizon_settings(options.horizon, input);
      horizons.emplace(plane->field, settings, terminal_progress("heights"));
      if (options.energy) sky.emplace(plane->field, settings, kSkyAzimuths, std::vector{SkyMeasure::sky_view_factor});
    }
    std::vector<float> seen;
    if (sky) seen = std::move(sky->rows(rows.first, rows.last, terminal_progress("sky view"))[0]);
    const ClearSkyGround ground{options.linke, options.albedo, seen};
    azimuths.clear();
    std::vector<ComputedBand> bands;
    for (std::size_t i = 0; i < periods.size(); ++i) {
      const Period& period = periods[i];
      const Moments up = moments_of(period, options, place, offset, plane->grid_north);
      for (const SunMoment& moment : up.moments) azimuths.push_back(moment.sun.azimuth);
      SunHours found = sun_hours(*horizons, up.moments, rows.first, rows.last, options.energy ? &ground : nullptr,
                                 progress_part(progress, static_cast<double>(i), count));
      for (const float hours : found.hours) longest = std::fmax(longest, static_cast<double>(hours));
      add_bands(bands, period.name, std::move(found), up, options);
    }
    return bands;
  };
  const auto summary = [&] {
    const std::string errors = horizon_errors_text(options.horizon, input, plane->field, azimuths, run.rows());
    return fmt::format("{} {}, at most {:.4g} hours of sun; {}{}", periods.size(),
                       periods.size() == 1 ? "period" : "periods", longest, input.curvature_text(), errors);
  };
  run.write({horizon_method(options.horizon) + kSunHoursMethod,
             metadata,
             "viridis",
             compute,
             summary,
             {&longest},
             !options.horizon.swept()});
}

}  // namespace

void add_sunhours(Program& program) {
  Command& command = program.add("sunhours", "Map how long the sun shines on an elevation model");
  const auto options = std::make_shared<SunHoursOptions>();
  SunHoursOptions& o = *options;
  command.add(&o.from, {.names = "--date",
                        .value = "DATE",
                        .help = "day, or first day of a range, for example 2026-06-21",
                        .common = true,
                        .required = true});
  const std::vector<std::string> of_maps{"--at"};
  const Rule of_pictures =
      needs("--at X,Y and a .svg, .pdf or .png output", [&o] { return !o.at.empty() && is_figure(o.output); });
  command.add(&o.to, {.names = "--to",
                      .value = "DATE",
                      .help = "last day",
                      .fallback = "that of --date",
                      .common = true,
                      .rules = {needs("a map or a table", [&o] { return o.at.empty() || !is_figure(o.output); })}});
  command.add(&o.at, {.names = "--at",
                      .value = "X,Y[,H]",
                      .help = "point instead of a map, with the height of the eye above the ground",
                      .fallback = "none",
                      .common = true});
  command.add(&o.step, {.names = "--step",
                        .value = "MIN",
                        .help = "minutes between positions of the sun",
                        .range = {1, kMinutesPerDay},
                        .fallback = "30; at a point 1",
                        .common = true});
  command.add(&o.sum, {.names = "--sum",
                       .value = "PERIOD",
                       .help = "period of a band",
                       .choices = {"day", "month", "range"},
                       .closed = true,
                       .common = true,
                       .excludes = of_maps});
  command.add(&o.first_last, {.names = "--first-last",
                              .help = "additional bands: local time of first and last sun",
                              .common = true,
                              .rules = {needs("--sum day, or a single day",
                                              [&o] { return o.sum == "day" || o.to.empty() || o.to == o.from; })},
                              .excludes = of_maps});
  command.add(&o.energy, {.names = "--energy",
                          .help = "additional bands or columns: energy under a clear sky",
                          .common = true,
                          .rules = {needs("a map or a table", [&o] { return o.at.empty() || !is_figure(o.output); })}});
  const Rule with_energy = needs("--energy", [&o] { return o.energy; });
  command.add(&o.linke, {.names = "--linke",
                         .value = "T",
                         .help = "Linke turbidity of the sky: 2 clean, 3 rural, 5 urban",
                         .range = {1, 8},
                         .common = true,
                         .rules = {with_energy}});
  command.add(&o.albedo, {.names = "--albedo",
                          .value = "A",
                          .help = "share of light that the ground reflects; snow 0.8",
                          .range = {0, 1},
                          .common = true,
                          .rules = {with_energy}});
  command.add(&o.offset, {.names = "--utc-offset",
                          .value = "+HH:MM",
                          .help = "UTC offset of local time",
                          .fallback = "whole hours, from the longitude",
                          .common = true});
  command.add(
      &o.refraction,
      {.names = "--refraction", .help = "raise the sun by the refraction of a standard atmosphere", .common = true});
  add_output_option(command, o.output,
                    "map, or with --at a .csv table or a .svg, .pdf or .png picture of the sun's path",
                    "tif tiff img asc csv svg pdf png", "point: standard output");
  add_plot_size_option(command, o.size, "1200x560", of_pictures);
  add_horizon_options(command, o.horizon, o.curvature, of_maps);
  add_map_coordinates_option(command, o.coordinates, {needs("--at X,Y", [&o] { return !o.at.empty(); })});
  add_map_command(
      command, o, [options, &command] { run(*options, command); }, of_maps);
  command.footer(kSunHoursFooter);
  command.example("scarp sunhours dem.tif --date 2026-06-21 -o hours.tif");
  command.example("scarp sunhours dem.tif --at 692000,5143000 --date 2026-12-21 -o sun.svg");
  command.example("scarp sunhours dem.tif --date 2026-01-01 --to 2026-12-31 --sum month --step 60 -o months.tif");
}

}  // namespace scarp::cli
