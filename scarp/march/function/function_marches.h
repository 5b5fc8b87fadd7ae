// SPDX-License-Identifier: MIT
// The marches `naive`, `fixed-step`, `relaxed` and `lipschitz` over a terrain function, as they are over height fields
// (naive.h, fixed_step.h, relaxed.h, lipschitz.h). A function has no cells and no holes: Hit::cell stays empty.
//
//   naive       t += max(0.7 |h|, share of the way out), stops at h < 0.001 t      approximate
//   fixed-step  t += 5 m, or a share of t, stops at h <= 0                        approximate
//   relaxed     t += 0.4 h, stops at |h| < 0.0015 t                               approximate
//   lipschitz   t += h / sqrt(1 + c^2), c the certified slope of the whole plane  conservative
//
// The approximate ones refine their last interval when told to (Refinement): `secant` is that of I. Quilez' Rainforest
// (2016), whose straight line ends where the clearance meets the tolerance, not the ground; over fixed-step, whose
// tolerance is 0, it is the interpolation of Quilez' "Terrain raymarching" (2002) and always on while
// FixedStepSettings::interpolate is.
//
// A ray is followed where it is within the range of the ground's heights, and within kFunctionReach. One that begins on
// the surface takes its first step unseen: `naive` its least step; the others 2^-10 of the way out, for want of cells.
// lipschitz_local.h decides about such rays without a blind step.
#pragma once

#include "scarp/base/ray.h"
#include "scarp/field/height_function.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Closest hit as the march finds it, by its own settings and settings.function. `stats` is overwritten: steps are
/// heights looked at.
Hit march_naive(const HeightFunction& function, const Ray& ray, const MarchSettings& settings = {},
                MarchStats* stats = nullptr, FunctionUse use = FunctionUse::march);
Hit march_fixed_step(const HeightFunction& function, const Ray& ray, const MarchSettings& settings = {},
                     MarchStats* stats = nullptr, FunctionUse use = FunctionUse::march);
Hit march_relaxed(const HeightFunction& function, const Ray& ray, const MarchSettings& settings = {},
                  MarchStats* stats = nullptr, FunctionUse use = FunctionUse::march);
/// Never passes the surface: stops above it, within settings.lipschitz.tolerance of the distance, or gives up
/// (exhausted). A shrink factor in the settings takes the place of the certified one, and then nothing is certain.
Hit march_lipschitz(const HeightFunction& function, const Ray& ray, const MarchSettings& settings = {},
                    MarchStats* stats = nullptr, FunctionUse use = FunctionUse::march);

}  // namespace scarp
