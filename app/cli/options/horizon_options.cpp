// SPDX-License-Identifier: MIT
#include "app/cli/options/horizon_options.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "app/options/numbers.h"
#include "scarp/analysis/horizon_errors.h"

namespace scarp::cli {

void add_horizon_options(Command& command, HorizonInput& horizon, std::optional<double>& curvature,
                         const std::vector<std::string>& excludes) {
  command.add(&horizon.eye_height, {.names = "--observer-height",
                                    .help = "height of the eye above the ground",
                                    .unit = "metres",
                                    .range = {0, kMostOfGround},
                                    .common = true});
  command.add(&horizon.max_distance, {.names = "--max-distance",
                                      .help = "maximum distance of ground that hides the sky",
                                      .unit = "metres",
                                      .range = {0, kMostOfGround, true},
                                      .fallback = "unlimited",
                                      .common = true,
                                      .rules = {needs("--engine exact", [&horizon] { return !horizon.swept(); })}});
  command.add(&horizon.engine, {.names = "--engine",
                                .value = "NAME",
                                .help = "sweep: approximate, about twice as fast",
                                .choices = {"exact", "sweep"},
                                .closed = true,
                                .common = true,
                                .excludes = excludes});
  add_curvature_option(command, curvature);
}

int rows_of_strip(const HorizonInput& horizon, const MapInput& input) {
  constexpr double kBytes = 9;  // as Horizons has
  constexpr int kRows = 2048;
  return kBytes * input.part().cols * input.part().rows > horizon.memory ? kRows : 1;
}

HorizonSettings horizon_settings(const HorizonInput& horizon, const MapInput& input) {
  HorizonSettings settings;
  settings.eye_height = horizon.eye_height;
  settings.max_distance = horizon.reach();
  settings.curvature = input.curvature();
  settings.memory = horizon.memory;
  settings.engine = horizon.swept() ? HorizonEngine::sweep : HorizonEngine::exact;
  return settings;
}

std::string horizon_method(const HorizonInput& horizon) {
  return horizon.swept() ? "horizons swept along lines, approximate beyond 8 pixels" : "exact horizons";
}

std::string horizon_errors_text(const HorizonInput& horizon, MapInput& input, std::span<const double> azimuths,
                                const RowBand& rows) {
  if (!horizon.swept()) return "";
  const HeightField field = input.whole_field(HUGE_VAL);
  const double grid_north = input.whole_grid_north();
  std::vector<double> directions;
  for (const double azimuth : azimuths) directions.push_back(azimuth - grid_north);
  const HorizonErrors errors = sampled_horizon_errors(field, horizon_settings(horizon, input), directions, rows);
  if (errors.count == 0) return "";
  return fmt::format("; {} angles compared with exact ones: 99 % within {:.2g} degrees, largest difference {:.2g}",
                     errors.count, errors.p99 * kDegreesPerRadian, errors.largest * kDegreesPerRadian);
}

Metadata horizon_metadata(const HorizonInput& horizon, const MapInput& input) {
  Metadata metadata{
      {"OBSERVER_HEIGHT", fmt::format("{:.10g} m above ground", horizon.eye_height)},
      {"MAX_DISTANCE", horizon.max_distance ? fmt::format("{:.10g} m", *horizon.max_distance) : "unlimited"},
      {"ENGINE", horizon.engine}};
  for (auto& pair : input.curvature_metadata()) metadata.push_back(std::move(pair));
  return metadata;
}

}  // namespace scarp::cli
