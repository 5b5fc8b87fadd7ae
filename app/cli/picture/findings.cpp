// SPDX-License-Identifier: MIT
#include "app/cli/picture/findings.h"

#include <fmt/format.h>

#include <string>

namespace scarp::cli {

void print_findings(const Picture& picture) {
  if (picture.steps) {
    const StepRange& steps = *picture.steps;
    const bool whole = steps.scale.low == steps.least && steps.scale.high == steps.most;
    if (whole) {
      fmt::print("steps per ray: {} (first colour of the ramp) to {} (last), mean {:.1f}\n", steps.least, steps.most,
                 steps.mean);
    } else {
      fmt::print("steps per ray: {} to {}, mean {:.1f}; colours of the ramp from {} to {}\n", steps.least, steps.most,
                 steps.mean, steps.scale.low, steps.scale.high);
    }
  }
  if (picture.heights) {
    fmt::print("heights: {:.6g} m (grey 1) to {:.6g} m (grey 255)\n", picture.heights->low, picture.heights->high);
  }
  if (!picture.errors) return;
  const ErrorCounts& errors = *picture.errors;
  for (const std::string& caveat : errors.caveats) fmt::print("{}\n", caveat);
  fmt::print("judged by {}; tolerance {} along the ray; pixels:\n", errors.judges,
             errors.tolerance_m > 0 ? fmt::format("{:.3g} m", errors.tolerance_m)
                                    : fmt::format("{:.3g} % of the distance", 100 * errors.share));
  for (int i = 0; i < kVerdicts; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    fmt::print("  {:10}  {:9}  {}\n", name_of(verdict), colour_name_of(verdict), errors[verdict]);
  }
  if (errors.proven > 0) {
    fmt::print("of these {} proven by interval bisection, which contradicts the judge {} times\n", errors.proven,
               errors.contradictions);
  }
}

}  // namespace scarp::cli
