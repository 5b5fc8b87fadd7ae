// SPDX-License-Identifier: MIT
#include "scarp/march/height/height_sampling.h"

#include "scarp/march/height/height_probe.h"
#include "scarp/march/sampling/sampling_loops.h"
#include "scarp/march/sampling/traced_probe.h"

namespace scarp {
namespace {

// Throws Error if the target lacks what the settings need.
auto lipschitz_loop(const HeightTarget& target, const MarchSettings& settings) {
  require(target, settings.lipschitz.shrink == 0 ? HeightPart::pyramid_and_slope : HeightPart::pyramid);
  return lipschitz_loop(settings, shrink_factor(settings.lipschitz, target.slope));
}

template <class March>
Hit traced(const HeightTarget& target, const Ray& ray, MarchStats* stats, MarchTrace& trace, const March& march) {
  return traced_over(
      ray, trace, [&](const auto& run) { return march_over(target, ray, stats, run); }, march);
}

}  // namespace

Hit march_naive(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  return march_over(target, ray, stats, naive_loop(settings));
}

Hit march_fixed_step(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  return march_over(target, ray, stats, fixed_step_loop(settings));
}

Hit march_relaxed(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  return march_over(target, ray, stats, relaxed_loop(settings));
}

Hit march_lipschitz(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  return march_over(target, ray, stats, lipschitz_loop(target, settings));
}

Hit traced_naive(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                 MarchTrace& trace) {
  return traced(target, ray, stats, trace, naive_loop(settings));
}

Hit traced_fixed_step(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                      MarchTrace& trace) {
  return traced(target, ray, stats, trace, fixed_step_loop(settings));
}

Hit traced_relaxed(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                   MarchTrace& trace) {
  return traced(target, ray, stats, trace, relaxed_loop(settings));
}

Hit traced_lipschitz(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                     MarchTrace& trace) {
  return traced(target, ray, stats, trace, lipschitz_loop(target, settings));
}

}  // namespace scarp
