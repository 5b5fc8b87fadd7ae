// SPDX-License-Identifier: MIT
// What the marches that take samples may answer in single precision.
//
// Where a march decides by what it finds at points that earlier decisions have led it to, rounding can lead it to other
// points than the march in double. So each is held to its own rule; and fixed-step, whose points are known beforehand,
// to the answer in double wherever no sample is within the bound of the surface.
#pragma once

#include <string>
#include <string_view>

#include "march/height/rounding_judge.h"
#include "scarp/march/march_settings.h"

namespace scarp::test {

/// Empty when `march` (naive, fixed-step, relaxed, lipschitz) may answer a ray so, else why not. `slope` is
/// slope_bound(field).
std::string sampling_objection(std::string_view march, const MarchSettings& settings, const HeightField& field,
                               double slope, const Ray& ray, const RoundingJudge& judge, const Hit& hit);

}  // namespace scarp::test
