// SPDX-License-Identifier: MIT
// The oracle of marches over distance fields: the first crossing of a ray by bisection in interval arithmetic, like
// function_exhaustive.h for functions.
//
// The tree of the shape is evaluated in intervals by separate code, which shares with the marches only the settings and
// boxes of nodes (distance_node.h) and the samples of height fields.
//
// Guarantee: a proof, including rounding. Cost: thousands of evaluations per ray. Source: see function_exhaustive.h.
#pragma once

#include "scarp/base/ray.h"
#include "scarp/field/distance_node.h"
#include "scarp/march/function/function_exhaustive.h"

namespace scarp {

/// Judges a ray; `above the ground` means `outside the solid`. The ray must be `free` and t_max finite; only its part
/// within +-kMostLength is judged.
FunctionJudgement judge_shape(const Shape& shape, const Ray& ray, int most_evaluations = 1 << 20);

}  // namespace scarp
