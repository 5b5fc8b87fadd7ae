// SPDX-License-Identifier: MIT
// The oracle of marches over terrain functions: the first crossing of a ray by bisection in interval arithmetic.
//
// The part of the ray over the ground is halved, leftmost interval first, until an interval is provably free of the
// ground or shorter than 1e-9 of that part. The tree of the function is evaluated in intervals by separate code, which
// shares with the marches only the settings (function_node.h), the lattice's integers and the bounds of noise (noise.h)
// and, for damped fractals, the gradient of noise at a point.
//
// Guarantee: a proof, including rounding. Cost: thousands of evaluations per ray. Source: R. E. Moore, "Interval
// analysis", 1966; for rays D. P. Mitchell, "Robust ray intersection with interval arithmetic", Graphics Interface
// 1990.
#pragma once

#include "scarp/base/ray.h"
#include "scarp/field/function_node.h"
#include "scarp/field/function_program.h"

namespace scarp {

enum class FunctionVerdict {
  clear,      ///< no crossing and no touch
  crossing,   ///< above the ground until clear_until, and below it at crossed_by
  undecided,  ///< no crossing until clear_until; then a touch or near touch, or the evaluation limit
};

/// Result of judge_function().
struct FunctionJudgement {
  FunctionVerdict verdict = FunctionVerdict::clear;
  double clear_until;  ///< t; t_max of the ray if clear
  double crossed_by;   ///< t, for a crossing; after an undecided point it may be far from clear_until
};

/// Judges a ray, which must be `free` with a finite t_max; only its part within +-kMostMetres in x, y and z is judged.
FunctionJudgement judge_function(const Function& function, const Ray& ray, FunctionUse use = FunctionUse::march,
                                 int most_evaluations = 1 << 20);

}  // namespace scarp
