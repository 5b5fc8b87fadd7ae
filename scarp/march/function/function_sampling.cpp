// SPDX-License-Identifier: MIT
#include "scarp/march/function/function_sampling.h"

#include "scarp/march/function/function_probe.h"
#include "scarp/march/sampling/sampling_loops.h"
#include "scarp/march/sampling/traced_probe.h"

namespace scarp {
namespace {

// Reduced by more than its three rounding errors.
auto lipschitz_loop(const HeightFunction& function, const MarchSettings& settings, FunctionUse use) {
  return lipschitz_loop(settings, shrink_factor(settings.lipschitz, function.bound_everywhere(use).slope, 0x1p-50));
}

template <class March>
Hit traced(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
           MarchTrace& trace, const March& march) {
  const auto over = [&](const auto& run) {
    return march_over(function, ray, FunctionUse::march, settings.function.reach, stats, run);
  };
  return traced_over(ray, trace, over, march);
}

}  // namespace

Hit march_naive(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                FunctionUse use) {
  return march_over(function, ray, use, settings.function.reach, stats, naive_loop(settings));
}

Hit march_fixed_step(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                     FunctionUse use) {
  return march_over(function, ray, use, settings.function.reach, stats, fixed_step_loop(settings));
}

Hit march_relaxed(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                  FunctionUse use) {
  return march_over(function, ray, use, settings.function.reach, stats, relaxed_loop(settings));
}

Hit march_lipschitz(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                    FunctionUse use) {
  return march_over(function, ray, use, settings.function.reach, stats, lipschitz_loop(function, settings, use));
}

Hit traced_naive(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                 MarchTrace& trace) {
  return traced(function, ray, settings, stats, trace, naive_loop(settings));
}

Hit traced_fixed_step(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                      MarchTrace& trace) {
  return traced(function, ray, settings, stats, trace, fixed_step_loop(settings));
}

Hit traced_relaxed(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                   MarchTrace& trace) {
  return traced(function, ray, settings, stats, trace, relaxed_loop(settings));
}

Hit traced_lipschitz(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                     MarchTrace& trace) {
  return traced(function, ray, settings, stats, trace, lipschitz_loop(function, settings, FunctionUse::march));
}

}  // namespace scarp
