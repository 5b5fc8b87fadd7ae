// SPDX-License-Identifier: MIT
#include "app/cli/options/horizon_options.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "app/options/numbers.h"

namespace scarp::cli {

void add_horizon_options(Command& command, HorizonInput& horizon, std::optional<double>& curvature) {
  command.add(&horizon.eye_height, {.names = "--observer-height",
                                    .help = "height of the eye above the ground",
                                    .unit = "metres",
                                    .range = {0, kMostOfGround},
                                    .common = true});
  command.add(&horizon.max_distance, {.names = "--max-distance",
                                      .help = "distance up to which ground hides the sky",
                                      .unit = "metres",
                                      .range = {0, kMostOfGround, true},
                                      .fallback = "unlimited",
                                      .common = true});
  add_curvature_option(command, curvature);
}

HorizonSettings horizon_settings(const HorizonInput& horizon, const MapInput& input) {
  HorizonSettings settings;
  settings.eye_height = horizon.eye_height;
  settings.max_distance = horizon.max_distance.value_or(std::numeric_limits<double>::infinity());
  settings.curvature = input.curvature();
  return settings;
}

HorizonPlane horizon_plane(MapInput& input) {
  const double col = (input.cols() - 1) / 2.0, row = (input.rows() - 1) / 2.0;
  return {input.field_at(col, row, HUGE_VAL), input.grid_north_at(col, row, HUGE_VAL)};
}

std::vector<std::pair<std::string, std::string>> horizon_metadata(const HorizonSettings& settings) {
  return {{"OBSERVER_HEIGHT", fmt::format("{:.10g} m above ground", settings.eye_height)},
          {"MAX_DISTANCE",
           std::isinf(settings.max_distance) ? "unlimited" : fmt::format("{:.10g} m", settings.max_distance)},
          {"CURVATURE_COEFFICIENT", fmt::format("{:.10g}", settings.curvature.coefficient)},
          {"DIAMETER", fmt::format("{:.10g} m", settings.curvature.diameter)}};
}

}  // namespace scarp::cli
