// SPDX-License-Identifier: MIT
#include "scarp/analysis/sun_hours.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scarp/analysis/horizon_state.h"
#include "scarp/base/setting.h"

namespace scarp {
namespace {

// Tables of this many moments are kept at once: 20 bytes per crossing.
constexpr std::size_t kMomentsTogether = 64;

}  // namespace

SunHours sun_hours(const Horizons& horizons, std::span<const SunMoment> moments, int first, int last,
                   const Progress& progress) {
  for (const SunMoment& moment : moments) {
    require_setting("sun hours", std::isfinite(moment.sun.azimuth), "sun azimuth", moment.sun.azimuth, "finite");
    require_setting("sun hours", moment.sun.altitude > 0 && moment.sun.altitude <= std::numbers::pi / 2, "sun altitude",
                    moment.sun.altitude, "above 0, at most pi/2");
    require_setting("sun hours", std::isfinite(moment.hours), "length of a moment", moment.hours, "finite");
  }
  const auto& state = state_of(horizons);
  require_rows(state.field, first, last);
  const std::ptrdiff_t cols = state.field.cols();
  SunHours found;
  found.hours.resize(static_cast<std::size_t>(cols * (last - first)));
  found.first.assign(found.hours.size(), -1), found.last.assign(found.hours.size(), -1);
  std::vector<double> sums(found.hours.size());  // hours; NaN on holes
  const double parts = static_cast<double>((moments.size() + kMomentsTogether - 1) / kMomentsTogether);
  for (std::size_t begin = 0; begin < moments.size(); begin += kMomentsTogether) {
    const std::size_t end = std::min(begin + kMomentsTogether, moments.size());
    std::vector<HorizonTable> tables;
    for (std::size_t i = begin; i < end; ++i)
      tables.emplace_back(state.ground, state.crossings(moments[i].sun.azimuth));
    const double done = static_cast<double>(begin / kMomentsTogether);
    const auto part_of_all = [&](double share) { return !progress || progress((done + share) / parts); };
    for_each_block(
        static_cast<int>(cols), first, last,
        [&](const NodeRect& block) {
          const int width = block.col_end - block.col_begin;
          std::vector<float> slopes(static_cast<std::size_t>(width) *
                                    static_cast<std::size_t>(block.row_end - block.row_begin));
          for (std::size_t i = begin; i < end; ++i) {
            scan_horizon(state.ground, tables[i - begin], state.eye(), block, slopes.data(), nullptr, width);
            const auto sun = static_cast<float>(std::tan(moments[i].sun.altitude));
            const float* slope = slopes.data();
            for (int row = block.row_begin; row < block.row_end; ++row) {
              auto at = static_cast<std::size_t>((row - first) * cols + block.col_begin);
              for (int col = 0; col < width; ++col, ++at, ++slope) {
                if (std::isnan(*slope)) sums[at] = std::numeric_limits<double>::quiet_NaN();
                if (!(*slope <= sun)) continue;
                sums[at] += moments[i].hours;
                if (found.first[at] < 0) found.first[at] = static_cast<std::int32_t>(i);
                found.last[at] = static_cast<std::int32_t>(i);
              }
            }
          }
        },
        part_of_all);
  }
  for (std::size_t i = 0; i < sums.size(); ++i) found.hours[i] = static_cast<float>(sums[i]);
  // Without a moment, no horizon tells of holes.
  for (std::size_t i = 0; moments.empty() && i < sums.size(); ++i) {
    const int row = first + static_cast<int>(i / static_cast<std::size_t>(cols));
    if (std::isnan(*state.ground.height(static_cast<int>(i % static_cast<std::size_t>(cols)), row)))
      found.hours[i] = std::numeric_limits<float>::quiet_NaN();
  }
  return found;
}

}  // namespace scarp
