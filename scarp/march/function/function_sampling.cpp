// SPDX-License-Identifier: MIT
#include "scarp/march/function/function_sampling.h"

#include "scarp/march/function/function_probe.h"
#include "scarp/march/sampling/fixed_step.h"
#include "scarp/march/sampling/lipschitz.h"
#include "scarp/march/sampling/naive.h"
#include "scarp/march/sampling/relaxed.h"

namespace scarp {

Hit march_naive(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                FunctionUse use) {
  return march_over(function, ray, use, settings.function.reach, stats,
                    [&](const auto& probe, MarchStats& counted) { return naive_over(probe, settings, counted); });
}

Hit march_fixed_step(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                     FunctionUse use) {
  return march_over(function, ray, use, settings.function.reach, stats,
                    [&](const auto& probe, MarchStats& counted) { return fixed_step_over(probe, settings, counted); });
}

Hit march_relaxed(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                  FunctionUse use) {
  return march_over(function, ray, use, settings.function.reach, stats,
                    [&](const auto& probe, MarchStats& counted) { return relaxed_over(probe, settings, counted); });
}

Hit march_lipschitz(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                    FunctionUse use) {
  // Reduced by more than its three rounding errors.
  const ShrinkFactor shrink = shrink_factor(settings.lipschitz, function.bound_everywhere(use).slope, 0x1p-50);
  return march_over(function, ray, use, settings.function.reach, stats, [&](const auto& probe, MarchStats& counted) {
    return lipschitz_over(probe, settings.lipschitz, shrink, counted);
  });
}

}  // namespace scarp
