// SPDX-License-Identifier: MIT
// `scarp shadow`: where the sun shines on an elevation model, as a raster.
#include "scarp/analysis/shadow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/kept_inputs.h"
#include "app/cli/map_input.h"
#include "app/cli/map_preview.h"
#include "app/cli/progress.h"
#include "app/cli/raster_output.h"
#include "app/cli/shared_options.h"
#include "scarp/analysis/map_part.h"
#ifdef SCARP_ERFA
#include "scarp/analysis/sun_position.h"
#endif
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp::cli {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kSunDiameter = 0.533 / kDegrees;  // radians, mean
constexpr int kNodata = 255;
constexpr const char* kMethod =
    "exact rays to the sun; ground linear at crossings of grid lines; flat Earth; grazing is lit (scarp shadow)";
constexpr const char* kFooter = R"(Pixels:
  0  lit
  1  self-shaded: the ground itself faces away from the sun
  2  cast shadow: ground farther away hides the sun
With --fraction: share of the sun's disc above the terrain, 0 to 1.)";

struct ShadowOptions : MapOptions {
  std::vector<std::string> suns, times;
  bool fraction = false, refraction = false;
  RasterOutput raster_output;
};

// A sun over the field; azimuth from grid north.
struct Sun {
  SunDirection direction;
  std::string name;   // of the band
  std::string place;  // azimuth and altitude in degrees
};

Sun sun_from(double azimuth, double altitude, double grid_north, std::string name) {
  return {{azimuth - grid_north, altitude},
          std::move(name),
          fmt::format("azimuth {:.4f}, altitude {:.4f} degrees", azimuth * kDegrees, altitude * kDegrees)};
}

#ifdef SCARP_ERFA
// The sun at the centre; `error`: how far it is off in the corners, radians.
Sun sun_at_time(MapInput& input, const std::string& text, bool refraction, double grid_north, double& error) {
  const double last_col = input.field().cols() - 1, last_row = input.field().rows() - 1;
  const auto position = [&](double col, double row) {
    const auto at = input.lonlat_of(col, row);
    if (!at)
      throw Error(fmt::format("{}: --time needs a raster with a CRS (give --raster-crs, or --sun)", input.path()));
    const double height = 0.5 * (input.field().min_height() + input.field().max_height());
    return sun_position(parse_time(text), {at->x / kDegrees, at->y / kDegrees, height}, refraction);
  };
  SunPosition sun;
  try {
    sun = position(last_col / 2, last_row / 2);
  } catch (const Error& error_of_time) {
    throw Error(fmt::format("--time: {}", error_of_time.what()));
  }
  for (const double col : {0.0, last_col})
    for (const double row : {0.0, last_row}) {
      const SunPosition corner = position(col, row);
      const double cosine = std::sin(sun.altitude) * std::sin(corner.altitude) +
                            std::cos(sun.altitude) * std::cos(corner.altitude) * std::cos(sun.azimuth - corner.azimuth);
      error = std::max(error, std::acos(std::min(cosine, 1.0)));
    }
  if (sun.altitude <= 0)
    throw Error(
        fmt::format("--time '{}': the sun is {:.2f} degrees below the horizon", text, -sun.altitude * kDegrees));
  return sun_from(sun.azimuth, sun.altitude, grid_north, text);
}
#endif

std::vector<Sun> suns_of(MapInput& input, const ShadowOptions& options) {
  const double col = (input.field().cols() - 1) / 2.0, row = (input.field().rows() - 1) / 2.0;
  const double grid_north = input.grid_north_at(col, row, HUGE_VAL);
  std::vector<Sun> suns;
  for (const std::string& text : options.suns) {
    constexpr std::string_view kForm =
        "AZIMUTH,ALTITUDE in degrees, altitude above 0 and at most 90, for example 135,20";
    const auto n = numbers_from(text, ',', 2, 2, "--sun", kForm);
    if (!(n[1] > 0 && n[1] <= 90) || std::abs(n[0]) > 360)
      throw Error(fmt::format("--sun '{}': expected {}", text, kForm));
    suns.push_back(sun_from(n[0] / kDegrees, n[1] / kDegrees, grid_north, fmt::format("sun {}", text)));
  }
  if (!options.times.empty()) {
#ifdef SCARP_ERFA
    double error = 0;
    for (const std::string& text : options.times)
      suns.push_back(sun_at_time(input, text, options.refraction, grid_north, error));
    input.notes.push_back(
        fmt::format("one sun for the whole raster, that at its centre; it is up to {:.3g} degrees off in the corners",
                    error * kDegrees));
#else
    throw Error("--time: this build does not compute the sun's position (SCARP_ERFA=OFF)");
#endif
  }
  if (suns.empty()) throw Error("no sun: give --sun AZIMUTH,ALTITUDE or --time TIME");
  return suns;
}

// Share of the disc's area that is lit: strips of equal height, each as its middle is.
std::vector<float> lit_fraction(const HeightField& field, const SunDirection& sun, const RowBand& rows,
                                const Progress& progress) {
  constexpr int kStrips = 16;
  std::vector<float> lit(static_cast<std::size_t>(field.cols()) * rows.rows(), 0);
  const auto area_below = [](double y) {  // of the unit disc, as a share
    return 0.5 + (y * std::sqrt(1 - y * y) + std::asin(y)) / std::numbers::pi;
  };
  for (int i = 0; i < kStrips; ++i) {
    const double low = 2.0 * i / kStrips - 1, high = 2.0 * (i + 1) / kStrips - 1;
    const double altitude = sun.altitude + (low + high) / 2 * kSunDiameter / 2;
    if (altitude <= 0 || altitude > std::numbers::pi / 2) continue;
    const auto weight = static_cast<float>(area_below(high) - area_below(low));
    const auto codes = shadow_rows(field, {sun.azimuth, altitude}, rows, progress);
    for (std::size_t k = 0; k < lit.size(); ++k) {
      if (codes[k] == Shade::lit) lit[k] += weight;
      if (codes[k] == Shade::hole) lit[k] = -1;
    }
  }
  return lit;
}

void run(ShadowOptions options, const Command& command) {
  command.require_effect({});
  settle_output(options.raster_output, options);
  const ThreadLimit limit(options.threads);
  const auto begin = std::chrono::steady_clock::now();
  MapInput input(options);
  keep_inputs(options.output, input.files());
  const std::vector<Sun> suns = suns_of(input, options);
  const HeightField field =
      input.field_at((input.field().cols() - 1) / 2.0, (input.field().rows() - 1) / 2.0, HUGE_VAL);
  const RowBand rows = rows_of_part(input, options.raster_output);
  const double nodes = static_cast<double>(field.cols()) * rows.rows();
  if (options.raster_output.dry_run) {
    constexpr double kNode_s = 1e-7;
    print_dry_run(input, rows, options.output, static_cast<double>(suns.size()) * (options.fraction ? 4 : 1) + 1,
                  nodes * kNode_s * static_cast<double>(suns.size()) * (options.fraction ? 16 : 1));
    return;
  }
  std::optional<MapPreview> preview;
  if (!options.raster_output.preview.empty()) preview.emplace(options.raster_output.preview, input);
  std::string places;
  for (const Sun& sun : suns) places += fmt::format("{}{}: {}", places.empty() ? "" : "; ", sun.name, sun.place);
  RasterMap map = map_of(input, options.raster_output, rows, kMethod, {{"SUN", places}});
  const Progress progress = terminal_progress("shadow");
  std::vector<std::vector<std::uint8_t>> codes(suns.size());
  std::vector<std::vector<float>> fractions(suns.size());
  double lit = 0;
  for (std::size_t i = 0; i < suns.size(); ++i) {
    if (options.fraction) {
      fractions[i] = lit_fraction(field, suns[i].direction, rows, progress);
      for (const float share : fractions[i]) lit += std::max(share, 0.0f);
      map.bands.push_back({fmt::format("lit share, {}", suns[i].name), "", std::span<const float>(fractions[i]), -1});
      continue;
    }
    const auto shades = shadow_rows(field, suns[i].direction, rows, progress);
    codes[i].reserve(shades.size());
    for (const Shade shade : shades)
      codes[i].push_back(shade == Shade::hole ? kNodata : static_cast<std::uint8_t>(shade));
    lit += static_cast<double>(std::count(codes[i].begin(), codes[i].end(), 0));
    map.bands.push_back({suns[i].name,
                         "",
                         std::span<const std::uint8_t>(codes[i]),
                         kNodata,
                         {{0, "lit", {255, 246, 214, 255}},
                          {1, "self-shaded", {136, 134, 158, 255}},
                          {2, "cast shadow", {52, 56, 92, 255}},
                          {kNodata, "no sample", {255, 255, 255, 0}}}});
  }
  write_raster_map(options.output, map, terminal_progress("write"));
  if (preview) preview->write(map, rows, "grey");
  print_map_summary(input, options.raster_output, rows, options.output,
                    fmt::format("{}; {:.3g} % lit", places, 100 * lit / nodes / static_cast<double>(suns.size())),
                    begin);
}

}  // namespace

void add_shadow(Program& program) {
  Command& command = program.add("shadow", "Map where the sun shines on an elevation model");
  const auto options = std::make_shared<ShadowOptions>();
  ShadowOptions& o = *options;
  command.add(&o.suns, {.names = "--sun",
                        .value = "AZ,ALT",
                        .help = "direction to the sun in degrees: clockwise from true north, above the horizon",
                        .note = "repeatable: one band each",
                        .repeats = true,
                        .common = true});
  command.add(&o.times, {.names = "--time",
                         .value = "TIME",
                         .help = "time with UTC offset, 2026-06-21T09:00+02:00",
                         .note = "repeatable: one band each",
                         .repeats = true,
                         .common = true});
  command.add(&o.refraction, {.names = "--refraction",
                              .help = "raise the sun of --time by the refraction of a standard atmosphere",
                              .common = true,
                              .rules = {needs("--time", [&o] { return !o.times.empty(); })}});
  command.add(
      &o.fraction,
      {.names = "--fraction", .help = "lit share of the sun's disc (0.533 degrees) instead of codes", .common = true});
  add_output_option(command, o.output, "raster to write", "tif tiff img asc");
  add_raster_output_options(command, o.raster_output);
  add_map_options(command, o);
  command.footer(kFooter);
  command.example("scarp shadow dem.tif --sun 135,20 -o shadow.tif");
  command.example("scarp shadow dem.tif --time 2026-06-21T09:00+02:00 --time 2026-06-21T18:00+02:00 -o shadow.tif");
  command.runs([options, &command] {
    options->typed = command.typed_values();
    run(*options, command);
  });
}

}  // namespace scarp::cli
