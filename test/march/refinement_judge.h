// SPDX-License-Identifier: MIT
// The effect of refinement on the hits of naive, fixed-step and relaxed over a height field, judged by `exhaustive`.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "scarp/base/ray.h"
#include "scarp/field/height_field.h"
#include "scarp/march/march_settings.h"

namespace scarp::test {

/// Vertical accuracy of hits, in cells.
constexpr double kRefinedTo = 1e-3;

struct RefinementErrors {
  int hits = 0;   ///< of rays that both settings call a hit
  int plain = 0;  ///< of them, those within kRefinedTo of the limit of the march's test without refinement
  int refined = 0;
  double along_plain = 0;  ///< sum of distances along the ray from where it first reaches that limit, in cells
  double along_refined = 0;
};

/// Traces rays with a march of these settings.
using CastAll = std::function<std::vector<Hit>(const HeightField&, std::span<const Ray>, const MarchSettings&)>;

/// Casts rays down to hills, without refinement and with the given one.
RefinementErrors refinement_errors(std::string_view march, Refinement refinement, const CastAll& cast);

}  // namespace scarp::test
