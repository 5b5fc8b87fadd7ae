// SPDX-License-Identifier: MIT
#include "app/cli/findings.h"

#include <fmt/format.h>

namespace scarp::cli {

void print_findings(const Picture& picture) {
  if (picture.steps) {
    fmt::print("steps per ray: {} (first colour of the ramp) to {} (last), mean {:.1f}\n", picture.steps->least,
               picture.steps->most, picture.steps->mean);
  }
  if (picture.heights) {
    fmt::print("heights: {:.6g} m (grey 1) to {:.6g} m (grey 255)\n", picture.heights->low, picture.heights->high);
  }
  if (picture.errors) {
    fmt::print("judged by exhaustive; tolerance {:.3g} m along the ray; pixels:\n", picture.errors->tolerance_m);
    for (int i = 0; i < kVerdicts; ++i) {
      const auto verdict = static_cast<Verdict>(i);
      fmt::print("  {:10}  {:9}  {}\n", name_of(verdict), colour_name_of(verdict), (*picture.errors)[verdict]);
    }
  }
}

}  // namespace scarp::cli
