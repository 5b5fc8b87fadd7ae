// SPDX-License-Identifier: MIT
#include "scarp/analysis/sun_hours.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scarp/analysis/horizon_state.h"
#include "scarp/base/setting.h"

namespace scarp {

SunHours sun_hours(const Horizons& horizons, std::span<const SunMoment> moments, int first, int last,
                   const Progress& progress) {
  for (const SunMoment& moment : moments) {
    require_setting("sun hours", std::isfinite(moment.sun.azimuth), "sun azimuth", moment.sun.azimuth, "finite");
    require_setting("sun hours", moment.sun.altitude > 0 && moment.sun.altitude <= std::numbers::pi / 2, "sun altitude",
                    moment.sun.altitude, "above 0, at most pi/2");
    require_setting("sun hours", std::isfinite(moment.hours), "length of a moment", moment.hours, "finite");
  }
  const auto& state = state_of(horizons);
  const RowBand band{first, last};
  require_band(state.field, band);
  const std::ptrdiff_t cols = state.field.cols();
  std::vector<double> sums;  // hours; NaN on holes
  for (int row = first; row < last; ++row) {
    const float* heights = state.relief.of_nodes().height(0, row);
    for (std::ptrdiff_t col = 0; col < cols; ++col)
      sums.push_back(std::isnan(heights[col]) ? std::numeric_limits<double>::quiet_NaN() : 0);
  }
  SunHours found;
  found.hours.resize(sums.size());
  found.first.assign(sums.size(), -1), found.last.assign(sums.size(), -1);
  std::vector<double> azimuths;
  for (const SunMoment& moment : moments) azimuths.push_back(moment.sun.azimuth);
  const auto add = [&](const HorizonBlock& block) {
    const SunMoment& moment = moments[block.azimuth];
    const auto sun = static_cast<float>(std::tan(moment.sun.altitude));
    const float* slope = block.slopes;
    for (int row = block.nodes.row_begin; row < block.nodes.row_end; ++row) {
      auto at = static_cast<std::size_t>((row - first) * cols + block.nodes.col_begin);
      for (int col = block.nodes.col_begin; col < block.nodes.col_end; ++col, ++at, ++slope) {
        if (!(*slope <= sun)) continue;  // holes, too
        sums[at] += moment.hours;
        found.last[at] = static_cast<std::int32_t>(block.azimuth);
        if (found.first[at] < 0) found.first[at] = found.last[at];
      }
    }
  };
  for_each_horizon(state, state.relief, azimuths, band, add, progress);
  for (std::size_t i = 0; i < sums.size(); ++i) found.hours[i] = static_cast<float>(sums[i]);
  return found;
}

}  // namespace scarp
