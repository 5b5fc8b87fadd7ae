// SPDX-License-Identifier: MIT
// Valid answers of the sampling marches in single precision.
//
// If the points of a march depend on earlier decisions, rounding can lead it to points other than those in double. Each
// of these marches therefore has its own rule; fixed-step, whose points are known beforehand, must return the answer in
// double wherever no sample is within the bound of the surface.
#pragma once

#include <string>
#include <string_view>

#include "march/height/rounding_judge.h"
#include "scarp/march/march_settings.h"

namespace scarp::test {

/// Empty if this is a valid answer of `march` (naive, fixed-step, relaxed, lipschitz), otherwise the reason. `slope` is
/// slope_bound(field).
std::string sampling_objection(std::string_view march, const MarchSettings& settings, const HeightField& field,
                               double slope, const Ray& ray, const RoundingJudge& judge, const Hit& hit);

}  // namespace scarp::test
