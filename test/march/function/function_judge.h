// SPDX-License-Identifier: MIT
// What a march over a terrain function in single precision may tell of a ray: that of the CPU for a ray that runs up to
// `delta` metres higher or lower. The CPU's lipschitz-local, itself proven against intervals
// (function_marches_test), is asked for both.
#pragma once

#include <string>
#include <string_view>

#include "scarp/base/ray.h"
#include "scarp/field/height_function.h"
#include "scarp/march/march_settings.h"

namespace scarp::test {

/// What is wrong with `hit`; empty: nothing. `delta` in metres.
std::string function_objection(std::string_view march, const MarchSettings& settings, const HeightFunction& function,
                               const Ray& ray, double delta, const Hit& hit);

}  // namespace scarp::test
