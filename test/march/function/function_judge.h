// SPDX-License-Identifier: MIT
// Answers that a march over a terrain function in single precision may give: those of the CPU for a ray up to `delta`
// metres higher or lower. Both come from the CPU's lipschitz-local, which function_marches_test proves against
// intervals.
#pragma once

#include <string>
#include <string_view>

#include "scarp/base/ray.h"
#include "scarp/field/height_function.h"
#include "scarp/march/march_settings.h"

namespace scarp::test {

/// Returns why `hit` is wrong, or an empty string. `delta` is in metres.
std::string function_objection(std::string_view march, const MarchSettings& settings, const HeightFunction& function,
                               const Ray& ray, double delta, const Hit& hit);

}  // namespace scarp::test
