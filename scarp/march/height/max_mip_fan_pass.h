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
#include "scarp/march/height/max_mip_resume.h"

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

// The line behind the hit of a ray, by the scalar march; far away if it misses.
inline std::int32_t line_behind_hit(const HeightTarget& target, const Fan& fan, const dvec3& direction,
                                    const RayScales& scales) {
  Ray ray;
  ray.origin = fan.origin, ray.direction = direction, ray.t_max = fan.t_max;
  const Hit hit = resume_max_mip(target, ray, max_mip::kNotClear);
  const double lines = hit.t * std::max(std::abs(direction.x * static_cast<double>(scales.per_x)),
                                        std::abs(direction.y * static_cast<double>(scales.per_y)));
  return hit && lines < kMostLines ? static_cast<std::int32_t>(lines) + 2 : std::numeric_limits<std::int32_t>::max();
}

// Whether a walk over these rays, a sample of a pass, is likely to take less time than a batch: whether most of them
// inherit. `last_line(i)`: the line up to which ray i of the middle lane goes; called only where the steepest edge of
// the field does not decide.
template <class Sample, class LastLine>
bool pass_pays(const Octant<Sample>& o, const StripLanes& lanes, const ReliefMap& map, float cell_relief,
               std::int32_t first, const LastLine& last_line) {
  constexpr std::size_t kLaneStep = 5;
  // With more of them broken, the batch that answers their rays takes the time that the walk saves.
  constexpr float kMostBroken = 0.1f;
  const std::int32_t rows = *std::max_element(lanes.count, lanes.count + N);
  const auto inherit = [&](const auto& steepest_of) {
    int links = 0, broken = 0;
    for (std::int32_t i = 1; i < rows; ++i) {
      const float steepest = steepest_of(i);
      for (std::size_t l = 0; l < N; l += kLaneStep) {
        if (i >= lanes.count[l]) continue;
        const std::size_t at = static_cast<std::size_t>(i) * N + l;
        ++links, broken += !inherits(lanes.m[at - N], lanes.s[at - N], lanes.m[at], lanes.s[at], steepest);
      }
    }
    return static_cast<float>(broken) <= kMostBroken * static_cast<float>(links);
  };
  if (inherit([&](std::int32_t) { return cell_relief; })) return true;
  WedgeRelief<Sample> relief(o, map, first, static_cast<double>(lanes.strip_least_m),
                             static_cast<double>(lanes.strip_most_m));
  std::int32_t last = first;
  return inherit([&](std::int32_t i) { return relief.up_to(last = std::max(last, last_line(i))); });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
