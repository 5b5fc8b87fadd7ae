// SPDX-License-Identifier: MIT
#include "scarp/march/height/height_sampling.h"

#include "scarp/march/height/height_probe.h"
#include "scarp/march/sampling/fixed_step.h"
#include "scarp/march/sampling/lipschitz.h"
#include "scarp/march/sampling/naive.h"
#include "scarp/march/sampling/relaxed.h"

namespace scarp {

Hit march_naive(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  return march_over(target, ray, stats,
                    [&](const auto& probe, MarchStats& counted) { return naive_over(probe, settings, counted); });
}

Hit march_fixed_step(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  return march_over(target, ray, stats,
                    [&](const auto& probe, MarchStats& counted) { return fixed_step_over(probe, settings, counted); });
}

Hit march_relaxed(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  return march_over(target, ray, stats,
                    [&](const auto& probe, MarchStats& counted) { return relaxed_over(probe, settings, counted); });
}

Hit march_lipschitz(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  require(target, settings.lipschitz.shrink == 0 ? HeightPart::pyramid_and_slope : HeightPart::pyramid);
  const ShrinkFactor shrink = shrink_factor(settings.lipschitz, target.slope);
  return march_over(target, ray, stats, [&](const auto& probe, MarchStats& counted) {
    return lipschitz_over(probe, settings.lipschitz, shrink, counted);
  });
}

}  // namespace scarp
