// SPDX-License-Identifier: MIT
// A pass of a fan's strip over one octant: where it begins and ends, and whether it pays off. Compiled once per
// instruction set.
#if defined(SCARP_MARCH_MAX_MIP_FAN_PASS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_MARCH_MAX_MIP_FAN_PASS_H
#undef SCARP_MARCH_MAX_MIP_FAN_PASS_H
#else
#define SCARP_MARCH_MAX_MIP_FAN_PASS_H
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "scarp/march/height/max_mip_fan_rays.h"
#include "scarp/march/height/max_mip_fan_walk.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

// The rays of a pass in the order of their slope, per lane: entry i of lane l is at i * N + l of m and s.
struct StripLanes {
  alignas(64) std::int32_t count[N];   // rays
  alignas(64) std::int32_t broken[N];  // the last ray that may not inherit from the one below it; -1: none
  alignas(64) float least_m[N];
  float strip_least_m, strip_most_m;
  float most_major;  // longest component along the major axis, in cells per t
  const float *m, *s;
};

// Heights relative to the origin: above `highest` rays are above all ground.
struct FanHeights {
  float highest, lowest;
};

// The last line of a pass. Wrapped ground has none: the pass goes to the end of the rays, or to where floats and the
// numbers of lines are still small.
constexpr std::int32_t kMostLines = 1 << 17;
template <class Sample>
std::int32_t end_line(const Octant<Sample>& o, const StripLanes& lanes, double t_max) {
  if (!o.wraps) return o.last_line();
  // Rounded up: by more than the way of a ray to t_max is rounded where it is compared with the last line.
  const double way = t_max * static_cast<double>(lanes.most_major) * (1 + 0x1p-18) + 3;
  return way < kMostLines ? static_cast<std::int32_t>(way) + 1 : kMostLines;
}

// The line after which the rays of the middle column come down so far from one another that a batch takes less time for
// the rest: from above all ground, with the ground at its mean height. Over wrapped ground, walks may be that long.
inline std::int32_t far_line(const StripLanes& lanes, const FanHeights& heights) {
  constexpr std::size_t kLane = N / 2;
  const float mean = 0.5f * (heights.highest + heights.lowest);
  float last = kMostLines;
  for (std::int32_t i = 0; i < lanes.count[kLane] && heights.highest < 0; ++i) {
    const float s = lanes.s[static_cast<std::size_t>(i) * N + kLane];
    const float T = s < 0 ? std::min(mean / s, static_cast<float>(kMostLines)) : kMostLines;
    if (i > 0 && T - last > max_mip::kFarthestGap) return static_cast<std::int32_t>(last) + 1;
    last = T;
  }
  return kMostLines;
}

// The line from which on rays may be near the ground.
template <class Sample>
std::int32_t first_line(const Octant<Sample>& o, const StripLanes& lanes, const FanHeights& heights, std::int32_t end) {
  double T = 0;
  if (heights.highest < 0) {
    T = std::numeric_limits<double>::infinity();
    for (std::size_t l = 0; l < N; ++l) {
      if (lanes.count[l] > 0 && lanes.s[l] < 0)
        T = std::min(T, static_cast<double>(heights.highest) / static_cast<double>(lanes.s[l]) * (1 - 0x1p-20));
    }
  }
  double first = std::floor(T + o.fx) - 1;
  if (!o.wraps) {
    // Beside the field there is no ground.
    first = std::max(first, -static_cast<double>(o.line0));
    if (o.node0 < 0 && lanes.strip_most_m > 0) {
      const double enters = (-o.node0 - o.fy) / static_cast<double>(lanes.strip_most_m) * (1 - 0x1p-20);
      first = std::max(first, std::floor(enters + o.fx) - 2);
    }
  }
  const auto line = static_cast<std::int32_t>(std::clamp(first, 0.0, static_cast<double>(std::max(end, 0))));
  return line == 0 && o.fx == 1 ? 1 : line;
}

// Whether most rays are likely to inherit, by some of them and the ground that the middle ray of a lane crosses.
template <class Sample>
bool worthwhile(const Octant<Sample>& o, const StripLanes& lanes, const FanHeights& heights, const ReliefMap& map,
                float cell_relief, std::int32_t end) {
  constexpr std::int32_t kSamples = 24;
  constexpr std::size_t kLaneStep = 5;
  constexpr double kFar = 0x1p17;
  // A ray by the batch takes about twice the time of one in a fan; bad links are guessed from the worst ground.
  constexpr float kMostBroken = 0.3f;
  const auto inherit = [&](float steepest) {
    int links = 0, broken = 0;
    for (std::size_t l = 0; l < N; l += kLaneStep) {
      const std::int32_t step = std::max(1, lanes.count[l] / kSamples);
      for (std::int32_t i = 1; i < lanes.count[l]; i += step) {
        const std::size_t at = static_cast<std::size_t>(i) * N + l;
        ++links, broken += !inherits(lanes.m[at - N], lanes.s[at - N], lanes.m[at], lanes.s[at], steepest);
      }
    }
    return static_cast<float>(broken) <= kMostBroken * static_cast<float>(links);
  };
  if (inherit(cell_relief)) return true;
  const std::int32_t first = std::max(first_line(o, lanes, heights, end) - 1, 0);
  std::int32_t last = first;
  for (std::size_t l = 0; l < N; l += kLaneStep) {
    if (lanes.count[l] == 0) continue;
    const float s = lanes.s[static_cast<std::size_t>(lanes.count[l] / 2) * N + l];
    const double T = s < 0 ? static_cast<double>(heights.lowest) / static_cast<double>(s) : kFar;
    last = std::max(last, static_cast<std::int32_t>(std::min(T, static_cast<double>(std::max(end, 0)))));
  }
  WedgeRelief<Sample> relief(o, map, first, static_cast<double>(lanes.strip_least_m),
                             static_cast<double>(lanes.strip_most_m));
  return inherit(relief.up_to(last));
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
