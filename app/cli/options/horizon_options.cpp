// SPDX-License-Identifier: MIT
#include "app/cli/options/horizon_options.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "app/options/numbers.h"

namespace scarp::cli {

void add_horizon_options(Command& command, HorizonInput& horizon, std::optional<double>& curvature) {
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
                                      .common = true});
  add_curvature_option(command, curvature);
}

HorizonSettings horizon_settings(const HorizonInput& horizon, const MapInput& input) {
  HorizonSettings settings;
  settings.eye_height = horizon.eye_height;
  settings.max_distance = horizon.reach();
  settings.curvature = input.curvature();
  return settings;
}

HorizonPlane horizon_plane(MapInput& input) {
  const dvec2 at = input.centre();
  return {input.field_at(at.x, at.y, HUGE_VAL), input.grid_north_at(at.x, at.y, HUGE_VAL)};
}

Metadata horizon_metadata(const HorizonInput& horizon, const MapInput& input) {
  Metadata metadata{
      {"OBSERVER_HEIGHT", fmt::format("{:.10g} m above ground", horizon.eye_height)},
      {"MAX_DISTANCE", horizon.max_distance ? fmt::format("{:.10g} m", *horizon.max_distance) : "unlimited"}};
  for (auto& pair : input.curvature_metadata()) metadata.push_back(std::move(pair));
  return metadata;
}

}  // namespace scarp::cli
