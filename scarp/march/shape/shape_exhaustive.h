// SPDX-License-Identifier: MIT
// The judge of the marches over distance fields: the first crossing of a ray by bisection in interval arithmetic, as
// function_exhaustive.h has it for functions.
//
// The tree of the shape is evaluated in intervals by code of its own, which shares with the marches the settings and
// boxes of nodes (distance_node.h) and the samples of height fields; nothing else.
//
// Guarantee: a proof, rounding included. Cost: some thousand evaluations per ray. Source: as there.
#pragma once

#include "scarp/base/ray.h"
#include "scarp/field/distance_node.h"
#include "scarp/march/function/function_exhaustive.h"

namespace scarp {

/// `above the ground` reads `outside of the solid`. The ray must be `free`, its part within +-kMostLength is judged,
/// and t_max must be finite.
FunctionJudgement judge_shape(const Shape& shape, const Ray& ray, int most_evaluations = 1 << 20);

}  // namespace scarp
