// SPDX-License-Identifier: MIT
// `scarp sunhours`: maps how long the sun shines on each pixel of an elevation model.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/commands/sunhours_point.h"
#include "app/cli/options/horizon_frames.h"
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
The sun of each step is that in its middle, at the centre of the raster or, with --sun-per-cell, of
each block. With --at or --points the output is CSV: date, first_sun, last_sun (local time, to the
second), hours, and with --energy energy, beam, diffuse, reflected; with --sum month or range period
instead of the first three. Or, of one point, a picture of the sun's path over the skyline.
With --masks, pixels are 1 in the sun, 0 in the shade and 255 without a sample, one band per step.)";

// The moments of a period when the sun is up, and the time of day in the middle of each, in hours.
struct Moments {
  std::vector<SunMoment> moments;
  std::vector<float> time;
};

// The steps of a period, with the sun for all places.
struct Step {
  SunAtTime sun;
  double hours, day_of_year;
  float time;        // of day, in its middle, in hours
  std::string name;  // date and time of its middle
};

// " 09:15", with seconds if there are any.
std::string clock_text(double minutes) {
  const auto seconds = static_cast<int>(std::lround(minutes * 60));
  return fmt::format(" {:02}:{:02}{}", seconds / 3600, seconds / 60 % 60,
                     seconds % 60 == 0 ? "" : fmt::format(":{:02}", seconds % 60));
}

std::vector<Step> steps_of(const SunPeriod& period, const SunHoursOptions& options, int offset) {
  std::vector<Step> steps;
  for (chrono::sys_days day = period.first; day <= period.last; day += chrono::days(1)) {
    const UtcTime midnight = midnight_of(day, 0);
    for (int minute = 0; minute < kMinutesPerDay; minute += options.minutes()) {
      const double length = std::min(options.minutes(), kMinutesPerDay - minute), middle = minute + 0.5 * length;
      steps.push_back({SunAtTime({midnight.day, (middle - offset) / kMinutesPerDay}), length / 60, day_of_year(day),
                       static_cast<float>(middle / 60), date_text(day) + clock_text(middle)});
    }
  }
  return steps;
}

Moments moments_of(const std::vector<Step>& steps, const EarthPlace& place, bool refraction, double grid_north) {
  Moments up;
  for (const Step& step : steps) {
    const SunPosition sun = step.sun.at(place, refraction);
    if (!(sun.altitude > 0)) continue;
    up.moments.push_back({{sun.azimuth - grid_north, sun.altitude}, step.hours, step.day_of_year});
    up.time.push_back(step.time);
  }
  return up;
}

// How much the zenith turns between the centre of the raster and its corners, radians.
double turn_of_zenith(const MapInput& input) {
  const Georeference& geo = input.georeference();
  return std::hypot(geo.cell_x_m * input.cols(), geo.cell_y_m * input.rows()) / input.curvature().diameter;
}

// The steps of --masks: those when the sun is up at the centre; with a sun per cell, those when it may be up anywhere.
// They depend on nothing that differs between parts.
std::vector<Step> masked_steps(const MapInput& input, const SunHoursOptions& options, int offset,
                               const EarthPlace& centre) {
  constexpr double kRefraction = 0.02;  // radians, more than the largest
  const double lowest = options.per_cell ? -turn_of_zenith(input) - kRefraction : 0;
  std::vector<Step> steps;
  for (Step& step : steps_of(periods_of(options).front(), options, offset))
    if (step.sun.at(centre, options.refraction).altitude > lowest) steps.push_back(std::move(step));
  if (steps.empty()) throw Error(fmt::format("--masks: the sun does not rise on {}", periods_of(options).front().name));
  return steps;
}

// Steps beyond this are taken for a mistake.
void require_few_steps(const MapInput& input, const SunHoursOptions& options, const std::vector<SunPeriod>& periods) {
  constexpr double kMost = 1e6, kHour = 3600;
  const double steps = static_cast<double>((periods.back().last - periods.front().first).count() + 1) *
                       std::ceil(static_cast<double>(kMinutesPerDay) / options.minutes());
  if (steps <= kMost) return;
  const double seconds =
      steps / 2 * input.cols() * input.rows() * options.horizon.node_azimuth_s() / std::thread::hardware_concurrency();
  throw Error(
      fmt::format("{:.0f} positions of the sun would take about {:.2g} hours; at most {:.0f} are allowed "
                  "(choose fewer days, or a longer --step)",
                  steps, seconds / kHour, kMost));
}

// The pixels of a period. Times are in hours; NaN without sun.
struct PeriodPixels {
  std::vector<float> hours, first, last;
  SunEnergy energy;
};

PeriodPixels pixels_of(SunHours found, const Moments& up, bool first_last) {
  PeriodPixels pixels{std::move(found.hours), {}, {}, std::move(found.energy)};
  const auto time_of = [&](std::int32_t moment) {
    return moment < 0 ? std::numeric_limits<float>::quiet_NaN() : up.time[static_cast<std::size_t>(moment)];
  };
  for (const auto& [moments, times] : {std::pair(&found.first, &pixels.first), std::pair(&found.last, &pixels.last)}) {
    if (!first_last) continue;
    times->resize(moments->size());
    std::transform(moments->begin(), moments->end(), times->begin(), time_of);
  }
  return pixels;
}

void paste_pixels(const PeriodPixels& of_block, const HorizonFrame& block, const RowBand& rows, int cols,
                  PeriodPixels& to) {
  const auto add = [&](const std::vector<float>& from, std::vector<float>& all) {
    if (!from.empty()) paste(from, block, rows, cols, all);
  };
  add(of_block.hours, to.hours), add(of_block.first, to.first), add(of_block.last, to.last);
  add(of_block.energy.beam, to.energy.beam), add(of_block.energy.diffuse, to.energy.diffuse);
  add(of_block.energy.reflected, to.energy.reflected);
}

// The bands of a period.
void add_bands(std::vector<ComputedBand>& bands, const std::string& name, PeriodPixels found,
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
  bands.push_back(number_band("first sun " + name, "h", std::move(found.first)));
  bands.push_back(number_band("last sun " + name, "h", std::move(found.last)));
}

// A band of each step: whether the sun shines.
std::vector<ComputedBand> mask_bands(const Horizons& horizons, const std::vector<HorizonFrame>& blocks,
                                     const std::vector<EarthPlace>& places, const std::vector<Step>& steps,
                                     bool refraction, const RowBand& rows, int cols, const Progress& progress) {
  constexpr std::uint8_t kHole = 255;
  std::vector<ComputedBand> bands;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    std::vector<std::uint8_t> lit(static_cast<std::size_t>(rows.rows()) * static_cast<std::size_t>(cols));
    const auto add = [&](const HorizonFrame& block, const Progress& of_block) {
      const Moments up = moments_of({steps[i]}, places[static_cast<std::size_t>(&block - blocks.data())], refraction,
                                    block.grid_north);
      const SunHours found =
          sun_hours(horizons.with_cells(block.cells.x, block.cells.y), up.moments, block.nodes, nullptr, of_block);
      std::vector<std::uint8_t> codes(found.hours.size());
      std::transform(found.hours.begin(), found.hours.end(), codes.begin(),
                     [](float hours) { return std::isnan(hours) ? kHole : static_cast<std::uint8_t>(hours > 0); });
      paste(codes, block, rows, cols, lit);
    };
    for_each_frame(blocks, add, progress_part(progress, static_cast<double>(i), static_cast<double>(steps.size())));
    bands.push_back({"sun " + steps[i].name,
                     "",
                     std::move(lit),
                     kHole,
                     {{0, "shade", {90, 90, 120, 255}}, {1, "sun", {255, 240, 190, 255}}}});
  }
  return bands;
}

EarthPlace place_of_sun(const MapInput& input, const dvec2& at, double height) {
  const auto lonlat = input.lonlat_of(at.x, at.y);
  if (!lonlat) throw Error(fmt::format("{}: the sun's position needs a raster with a CRS (give --crs)", input.path()));
  return {lonlat->x / kDegreesPerRadian, lonlat->y / kDegreesPerRadian, height};
}

// Between the corners of a raster and its centre, the zenith turns by their distance.
void note_one_sun(MapInput& input, const SunHoursOptions& options) {
  constexpr double kWorthANote = 0.05;  // degrees
  const double off = turn_of_zenith(input) * kDegreesPerRadian;
  if (options.per_cell || off <= kWorthANote) return;
  input.notes.push_back(
      fmt::format("one sun for the whole raster, that at its centre; it is up to {:.2g} degrees off in the corners{}",
                  off, options.horizon.swept() ? "" : " (--sun-per-cell)"));
}

Metadata sun_metadata(const SunHoursOptions& options, const MapInput& input, const HorizonFrames& frames,
                      const std::vector<SunPeriod>& periods, int offset) {
  Metadata metadata = horizon_metadata(options.horizon, input);
  for (auto& pair : frames.metadata()) metadata.push_back(std::move(pair));
  metadata.emplace_back("SUN", options.per_cell ? "at the middle of each block" : "at the centre of the raster");
  metadata.emplace_back("STEP", fmt::format("{} minutes", options.minutes()));
  metadata.emplace_back("UTC_OFFSET", offset_text(offset));
  metadata.emplace_back("DATES", dates_text(periods.front().first, periods.back().last));
  metadata.emplace_back("REFRACTION", options.refraction ? "standard atmosphere" : "none");
  if (!options.energy) return metadata;
  if (options.transmittance) {
    metadata.emplace_back("ENERGY", "beam by transmittance^(air mass), diffuse by Liu and Jordan 1960");
    metadata.emplace_back("TRANSMITTANCE", fmt::format("{:.10g}", *options.transmittance));
  } else {
    metadata.emplace_back("ENERGY", "clear sky of the European Solar Radiation Atlas (Rigollier 2000)");
    metadata.emplace_back("LINKE_TURBIDITY", fmt::format("{:.10g}", options.linke));
  }
  metadata.emplace_back("ALBEDO", fmt::format("{:.10g}", options.albedo));
  return metadata;
}

void run(SunHoursOptions options, const Command& command) {
  if (options.at_points()) return write_point_sun(options);
  if (options.output.empty()) throw WrongUsage("-o FILE is required (see 'scarp sunhours --help')");
  const std::vector<SunPeriod> periods = periods_of(options);
  const chrono::sys_days from = periods.front().first, to = periods.back().last;
  const auto count = static_cast<double>(periods.size()), days = static_cast<double>((to - from).count() + 1);
  const std::optional<int> typed_offset = offset_of(options.offset);
  MapRun run(options, command, options.masks ? "Byte" : "Float32");
  MapInput& input = run.input();
  require_few_steps(input, options, periods);
  const double longitude = place_of_sun(input, input.centre(), 0).longitude * kDegreesPerRadian;
  const HorizonFrames frames(input, options.horizon, options.plane_error,
                             options.per_cell ? FrameUse::suns : FrameUse::lengths);
  const int offset = typed_offset.value_or(offset_by_longitude(longitude));
  if (!typed_offset)
    input.notes.push_back(
        fmt::format("days start at midnight UTC{}, chosen from the longitude (--utc-offset)", offset_text(offset)));
  note_one_sun(input, options);
  run.set_reach(options.horizon.reach());
  // Not from the samples of a part: all parts have the same sun.
  const double height = options.raster_output.dry_run ? 0 : input.height_at_centre().value_or(0);
  const EarthPlace place = place_of_sun(input, input.centre(), height);
  std::vector<Step> masked;
  if (options.masks) masked = masked_steps(input, options, offset, place);
  const int bands_per_period = 1 + (options.energy ? 4 : 0) + (options.first_last ? 2 : 0);
  const double bytes = options.masks ? static_cast<double>(masked.size()) : 4 * count * bands_per_period;
  const double suns = days * kMinutesPerDay / options.minutes() / 2 + (options.energy ? kSkyAzimuths : 0);
  if (!run.begin(29 + bytes, suns * options.horizon.node_azimuth_s())) return;
  options.horizon.memory = run.working_memory() / (options.energy ? 2 : 1);
  double longest = 0;
  std::optional<Horizons> horizons;
  std::optional<SkyView> sky;
  std::vector<double> azimuths;
  const auto compute = [&](const RowBand& rows, const Progress& progress) {
    if (!horizons) {
      const HorizonSettings settings = horizon_settings(options.horizon, input);
      horizons.emplace(input.field(), settings, terminal_progress("heights"));
      if (options.energy) sky.emplace(input.field(), settings, kSkyAzimuths, std::vector{SkyMeasure::sky_view_factor});
    }
    const std::vector<HorizonFrame> blocks = frames.of(input, rows);
    const auto number_of = [&](const HorizonFrame& block) { return static_cast<std::size_t>(&block - blocks.data()); };
    std::vector<EarthPlace> places;  // of the suns
    for (const HorizonFrame& block : blocks)
      places.push_back(options.per_cell ? place_of_sun(input, block.middle, height) : place);
    std::vector<std::vector<float>> seen(blocks.size());
    const auto see = [&](const HorizonFrame& block, const Progress& of_block) {
      seen[number_of(block)] = std::move(sky->with_cells(block.cells.x, block.cells.y).block(block.nodes, of_block)[0]);
    };
    if (sky) for_each_frame(blocks, see, terminal_progress("sky view"));
    const int cols = input.part().cols;
    azimuths.clear();
    const auto remember = [&](const std::vector<Step>& steps) {
      for (const SunMoment& moment : moments_of(steps, place, options.refraction, 0).moments)
        azimuths.push_back(moment.sun.azimuth);
    };
    if (options.masks) {
      remember(masked);
      return mask_bands(*horizons, blocks, places, masked, options.refraction, rows, cols, progress);
    }
    const std::vector<float> nothing(static_cast<std::size_t>(rows.rows()) * static_cast<std::size_t>(cols));
    std::vector<ComputedBand> bands;
    for (std::size_t i = 0; i < periods.size(); ++i) {
      const std::vector<Step> steps = steps_of(periods[i], options, offset);
      PeriodPixels pixels{nothing, {}, {}, {}};
      if (options.first_last) pixels.first = pixels.last = nothing;
      if (options.energy) pixels.energy = {nothing, nothing, nothing};
      const auto add = [&](const HorizonFrame& block, const Progress& of_block) {
        const std::size_t number = number_of(block);
        const ClearSkyGround ground{options.linke, options.albedo, seen[number], options.transmittance};
        const Moments up = moments_of(steps, places[number], options.refraction, block.grid_north);
        SunHours found = sun_hours(horizons->with_cells(block.cells.x, block.cells.y), up.moments, block.nodes,
                                   options.energy ? &ground : nullptr, of_block);
        paste_pixels(pixels_of(std::move(found), up, options.first_last), block, rows, cols, pixels);
      };
      for_each_frame(blocks, add, progress_part(progress, static_cast<double>(i), count));
      remember(steps);
      for (const float hours : pixels.hours) longest = std::fmax(longest, static_cast<double>(hours));
      add_bands(bands, periods[i].name, std::move(pixels), options);
    }
    return bands;
  };
  const auto summary = [&] {
    const std::string errors = horizon_errors_text(options.horizon, input, azimuths, run.rows());
    const std::string what = options.masks ? fmt::format("{} steps with the sun up", masked.size())
                                           : fmt::format("{} {}, at most {:.4g} hours of sun", periods.size(),
                                                         periods.size() == 1 ? "period" : "periods", longest);
    return fmt::format("{}; {}{}", what, input.curvature_text(), errors);
  };
  run.write({horizon_method(options.horizon) + kSunHoursMethod,
             sun_metadata(options, input, frames, periods, offset),
             "viridis",
             compute,
             summary,
             {&longest},
             !options.horizon.swept(),
             rows_of_strip(options.horizon, input)});
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
  const std::vector<std::string> of_maps{"--at", "--points"};
  const Rule of_pictures =
      needs("--at X,Y and a .svg, .pdf or .png output", [&o] { return o.at_points() && is_figure(o.output); });
  const Rule table_or_map = needs("a map or a table", [&o] { return !o.at_points() || !is_figure(o.output); });
  command.add(&o.to, {.names = "--to",
                      .value = "DATE",
                      .help = "last day",
                      .fallback = "that of --date",
                      .common = true,
                      .rules = {table_or_map}});
  command.add(&o.at, {.names = "--at",
                      .value = "X,Y[,H]",
                      .help = "point instead of a map, with the height of the eye above the ground",
                      .fallback = "none",
                      .common = true});
  add_points_option(command, o.points);
  command.add(&o.step, {.names = "--step",
                        .value = "MIN",
                        .help = "minutes between positions of the sun",
                        .range = {1, kMinutesPerDay},
                        .fallback = "30; at points 1",
                        .common = true});
  command.add(&o.sum, {.names = "--sum",
                       .value = "PERIOD",
                       .help = "period of a band, or of a row of a table",
                       .choices = {"day", "month", "range"},
                       .closed = true,
                       .fallback = "range; at points day",
                       .common = true,
                       .rules = {table_or_map}});
  command.add(&o.first_last, {.names = "--first-last",
                              .help = "additional bands: local time of first and last sun",
                              .common = true,
                              .rules = {needs("--sum day, or a single day",
                                              [&o] { return o.period() == "day" || o.to.empty() || o.to == o.from; })},
                              .excludes = of_maps});
  command.add(&o.masks, {.names = "--masks",
                         .help = "instead of hours: a band per step with the sun up, 1 in the sun, 0 in the shade",
                         .common = true,
                         .excludes = {"--at", "--points", "--sum", "--first-last", "--energy"}});
  command.add(&o.energy, {.names = "--energy",
                          .help = "additional bands or columns: energy under a clear sky",
                          .common = true,
                          .rules = {table_or_map}});
  const Rule with_energy = needs("--energy", [&o] { return o.energy; });
  command.add(&o.linke, {.names = "--linke",
                         .value = "T",
                         .help = "Linke turbidity of the sky: 2 clean, 3 rural, 5 urban",
                         .range = {1, 8},
                         .common = true,
                         .rules = {with_energy}});
  command.add(&o.transmittance, {.names = "--transmittance",
                                 .value = "T",
                                 .help = "share of the sun's beam that comes down to the sea from the zenith",
                                 .range = {0.1, 1},
                                 .note = "instead of --linke; clear sky 0.6 to 0.7",
                                 .fallback = "none",
                                 .common = true,
                                 .rules = {with_energy},
                                 .excludes = {"--linke"}});
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
  command.add(&o.per_cell, {.names = "--sun-per-cell",
                            .help = "the sun and north of each block of pixels instead of those at the centre",
                            .note = "blocks in which neither turns by more than 0.05 degrees, at least 128 x 128",
                            .common = true,
                            .rules = {needs("--engine exact", [&o] { return !o.horizon.swept(); })},
                            .excludes = of_maps});
  command.add(
      &o.refraction,
      {.names = "--refraction", .help = "raise the sun by the refraction of a standard atmosphere", .common = true});
  add_output_option(command, o.output,
                    "map, or at points a .csv table or a .svg, .pdf or .png picture of the sun's path",
                    "tif tiff img asc csv svg pdf png", "points: standard output");
  add_plot_size_option(command, o.size, "1200x560", of_pictures);
  add_horizon_options(command, o.horizon, o.curvature, of_maps);
  add_map_coordinates_option(command, o.coordinates, {needs("--at or --points", [&o] { return o.at_points(); })});
  add_map_command(
      command, o, [options, &command] { run(*options, command); }, of_maps);
  command.footer(kSunHoursFooter);
  command.example("scarp sunhours dem.tif --date 2026-06-21 -o hours.tif");
  command.example("scarp sunhours dem.tif --at 692000,5143000 --date 2026-12-21 -o sun.svg");
  command.example("scarp sunhours dem.tif --points roofs.csv --date 2026-01-01 --to 2026-12-31 --sum month");
  command.example("scarp sunhours dem.tif --date 2026-01-01 --to 2026-12-31 --sum month --step 60 -o months.tif");
}

}  // namespace scarp::cli
