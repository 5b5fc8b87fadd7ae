// SPDX-License-Identifier: MIT
// `fixed-step`: samples at a constant distance along the ray; a hit is where one is no longer above the ground.
//
//   o   o   o   o          plain: the hit is the sample that is first on or below the ground
//        _____  \ x        interpolated: between the last two samples, where a straight line between their clearances
//   ____/     \_/ o\_      crosses zero
//
// Guarantee: approximate. What is thinner than a step is stepped over. The last sample is where the ray leaves the
// field or its range ends; samples are counted, not summed up. Source: the ray caster for semi-voxel terrain of the
// founding texts, first plain, then interpolating the last two samples. Cost: one height per step.
#pragma once

#include "scarp/march/height/height_target.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Closest hit as this march finds it, in [t_min, t_max] and inside the field. Walls of solid ground are hit at the
/// first sample behind them. Uses settings.fixed_step; no pyramid.
Hit march_fixed_step(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                     MarchStats* stats = nullptr);

}  // namespace scarp
