// SPDX-License-Identifier: MIT
// `fixed-step`: samples at a constant distance along the ray; the first sample that is no longer above the ground is a
// hit.
//
//   o   o   o   o          plain: the hit is the sample that is first on or below the ground
//        _____  \ x        interpolated: between the last two samples, where a straight line between their clearances
//   ____/     \_/ o\_      crosses zero (the default); or bisected (Refinement)
//
// Guarantee: approximate. Steps over anything thinner than a step. The last sample is where the ray leaves the field or
// its range ends. Sample positions are computed from their index, not accumulated. Sources: the ray caster for
// semi-voxel terrain of the founding texts, first plain, then interpolating the last two samples; I. Quilez, "Terrain
// raymarching", 2002. Cost: one height per step.
#pragma once

#include "scarp/field/height_function.h"
#include "scarp/march/height/height_target.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Returns the closest hit that this march finds, in [t_min, t_max] and inside the field. Walls of solid ground are hit
/// at the first sample behind them. Uses settings.fixed_step and settings.sampling; no pyramid.
Hit march_fixed_step(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                     MarchStats* stats = nullptr);
/// The same over a terrain function, within settings.function.reach. Steps are settings.function.step long, or grow
/// with the distance by settings.function.step_share.
Hit march_fixed_step(const HeightFunction& function, const Ray& ray, const MarchSettings& settings = {},
                     MarchStats* stats = nullptr, FunctionUse use = FunctionUse::march);

}  // namespace scarp
