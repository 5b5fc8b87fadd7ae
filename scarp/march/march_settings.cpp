// SPDX-License-Identifier: MIT
#include "scarp/march/march_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scarp/base/error.h"
#include "scarp/base/setting.h"

namespace scarp {
namespace {

void require(bool good, std::string_view name, double value, std::string_view range) {
  if (!good) throw Error(fmt::format("march setting {}: is {} (must be {})", name, value, range));
}

// In the order of Refinement.
constexpr std::array<std::string_view, 3> kRefinements = {"none", "secant", "bisect"};

bool positive(double x) { return std::isfinite(x) && x > 0; }

}  // namespace

std::string_view name_of(Refinement refinement) { return kRefinements[static_cast<std::size_t>(refinement)]; }

Refinement find_refinement(std::string_view name) {
  return static_cast<Refinement>(find_setting("refinement", kRefinements, name));
}

void validate(const MarchSettings& settings) {
  const auto& naive = settings.naive;
  require(positive(naive.step_factor), "naive step factor", naive.step_factor, "above 0");
  require(positive(naive.min_step) && naive.min_step <= 1, "naive least step", naive.min_step, "above 0 and at most 1");
  require(std::isfinite(naive.tolerance) && naive.tolerance >= 0, "naive tolerance", naive.tolerance, "0 or more");
  require(naive.max_steps >= 1, "naive step limit", naive.max_steps, "1 or more");
  const auto& fixed_step = settings.fixed_step;
  require(positive(fixed_step.step), "fixed-step step", fixed_step.step, "above 0");
  require(fixed_step.max_steps >= 1, "fixed-step step limit", fixed_step.max_steps, "1 or more");
  const auto& relaxed = settings.relaxed;
  require(positive(relaxed.step_factor), "relaxed step factor", relaxed.step_factor, "above 0");
  require(positive(relaxed.tolerance) || (relaxed.tolerance == 0 && settings.sampling.tolerance > 0),
          "relaxed tolerance", relaxed.tolerance, "above 0, or 0 with a sampling tolerance above 0");
  require(relaxed.max_steps >= 1, "relaxed step limit", relaxed.max_steps, "1 or more");
  const auto& lipschitz = settings.lipschitz;
  require(lipschitz.shrink >= 0 && lipschitz.shrink <= 1, "lipschitz shrink factor", lipschitz.shrink,
          "above 0 and at most 1, or 0 for that of the slope bound");
  require(std::isfinite(lipschitz.tolerance) && lipschitz.tolerance >= 0, "lipschitz tolerance", lipschitz.tolerance,
          "0 or more");
  require(lipschitz.max_steps >= 1, "lipschitz step limit", lipschitz.max_steps, "1 or more");
  const auto& local = settings.lipschitz_local;
  require(std::isfinite(local.tolerance) && local.tolerance >= 0, "lipschitz-local tolerance", local.tolerance,
          "0 or more");
  require(local.max_steps >= 1, "lipschitz-local step limit", local.max_steps, "1 or more");
  const auto& function = settings.function;
  require(function.reach > 0, "function reach", function.reach, "above 0 metres");
  require(positive(function.step), "function step", function.step, "above 0 metres");
  require(std::isfinite(function.step_share) && function.step_share >= 0, "function step share", function.step_share,
          "0 or more");
  const auto& sampling = settings.sampling;
  require(std::isfinite(sampling.tolerance) && sampling.tolerance >= 0, "sampling tolerance", sampling.tolerance,
          "0 or more metres");
  require(sampling.halvings >= 1 && sampling.halvings <= 60, "refinement halvings", sampling.halvings, "1 to 60");
  const auto& sphere_trace = settings.sphere_trace;
  require(std::isfinite(sphere_trace.tolerance) && sphere_trace.tolerance >= 0, "sphere-trace tolerance",
          sphere_trace.tolerance, "0 or more");
  require(sphere_trace.max_steps >= 1, "sphere-trace step limit", sphere_trace.max_steps, "1 or more");
  require(settings.bisect.halvings >= 1 && settings.bisect.halvings <= 60, "bisect halvings", settings.bisect.halvings,
          "1 to 60");
}

}  // namespace scarp
