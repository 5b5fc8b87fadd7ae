// SPDX-License-Identifier: MIT
#include "scarp/base/march_trace.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace scarp {

std::string_view name_of(TraceKind kind) {
  static constexpr std::array<std::string_view, 11> kNames{
      "sample",      "hole",  "refinement", "passed-block", "entered-block", "passed-cell",
      "tested-cell", "voxel", "cube",       "sphere",       "solid"};
  return kNames[static_cast<std::size_t>(kind)];
}

void MarchTrace::scale_times(int exponent) {
  for (TraceStep& step : steps) step.t = std::ldexp(step.t, -exponent), step.t_out = std::ldexp(step.t_out, -exponent);
}

}  // namespace scarp
