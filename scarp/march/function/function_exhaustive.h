// SPDX-License-Identifier: MIT
// The judge of the marches over terrain functions: the first crossing of a ray by bisection in interval arithmetic.
//
// The ray's part over the ground is halved until an interval is provably free of the ground, or shorter than 1e-9 of
// that part; the leftmost first. The tree of the function is evaluated in intervals by code of its own, which shares
// with the marches the settings (function_node.h), the lattice's integers and the bounds of noise (noise.h) and, where
// a fractal is damped, the gradient of noise at a point; nothing else.
//
// Guarantee: a proof, rounding included. Cost: some thousand evaluations per ray. Source: R. E. Moore, "Interval
// analysis", 1966; for rays D. P. Mitchell, "Robust ray intersection with interval arithmetic", Graphics Interface
// 1990.
#pragma once

#include "scarp/base/ray.h"
#include "scarp/field/function_node.h"
#include "scarp/field/function_program.h"

namespace scarp {

enum class FunctionVerdict {
  clear,      ///< no crossing and no touch
  crossing,   ///< above the ground until clear_until, and under it at crossed_by
  undecided,  ///< no crossing until clear_until; then a touch or nearly one, or used-up evaluations
};

struct FunctionJudgement {
  FunctionVerdict verdict = FunctionVerdict::clear;
  double clear_until;  ///< t; t_max of the ray when it is clear
  double crossed_by;   ///< t, for a crossing; after an undecided place it may be far from clear_until
};

/// The ray must be `free`, its part within +-kMostMetres in x, y and z is judged, and t_max must be finite.
FunctionJudgement judge_function(const Function& function, const Ray& ray, FunctionUse use = FunctionUse::march,
                                 int most_evaluations = 1 << 20);

}  // namespace scarp
