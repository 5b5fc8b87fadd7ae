// SPDX-License-Identifier: MIT
// Private to the station: the settings of naive, fixed-step, relaxed and lipschitz in the layout of shaders.
#pragma once

#include "scarp/march/march_settings.h"
#include "scarp/march/sampling/sampling_marches.glsl.h"
#include "scarp/march/sampling/shrink_factor.h"
#include "scarp/march/sampling_kind.h"

namespace scarp {

// Cast below.
static_assert(glsl::kScarpRefineNone == static_cast<glsl::uint>(Refinement::none) &&
              glsl::kScarpRefineSecant == static_cast<glsl::uint>(Refinement::secant) &&
              glsl::kScarpRefineBisect == static_cast<glsl::uint>(Refinement::bisect));

/// Returns the device settings of a sampling march. The step of fixed-step is in cells. `slope` is the slope bound for
/// lipschitz, whose proven factor is reduced by the fraction `rounding`. A unit of clearance is `unit` metres.
inline glsl::ScarpSampling device_sampling(Sampling march, const MarchSettings& all, double slope, double rounding,
                                           double unit) {
  const auto f = [](double value) { return static_cast<float>(value); };
  glsl::ScarpSampling settings;
  switch (march) {
    case Sampling::lipschitz: {
      const ShrinkFactor shrink = shrink_factor(all.lipschitz, slope, rounding);
      settings = glsl::scarp_lipschitz(f(shrink.factor), f(all.lipschitz.tolerance), all.lipschitz.max_steps);
      settings.proven = shrink.guarantee == Guarantee::conservative;
      return settings;
    }
    case Sampling::naive:
      settings = glsl::scarp_naive(f(all.naive.step_factor), f(all.naive.min_step), f(all.naive.tolerance),
                                   all.naive.max_steps);
      break;
    case Sampling::relaxed:
      settings = glsl::scarp_relaxed(f(all.relaxed.step_factor), f(all.relaxed.tolerance), all.relaxed.max_steps);
      break;
    case Sampling::fixed_step:
      [[fallthrough]];
    case Sampling::none:
      settings = glsl::scarp_fixed_step(f(all.fixed_step.step), 0, all.fixed_step.max_steps);
  }
  settings.height = f(all.sampling.tolerance / unit);
  settings.refinement =
      static_cast<glsl::uint>(march == Sampling::fixed_step ? refinement_of_fixed_step(all) : all.sampling.refinement);
  settings.halvings = all.sampling.halvings;
  return settings;
}

}  // namespace scarp
