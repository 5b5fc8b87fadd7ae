// SPDX-License-Identifier: MIT
// `relaxed`: the march of many terrain shaders. t += 0.4 * h, a hit where |h| < 0.0015 * t, 300 steps; t
// counted from t_min.
//
// The factor below 1 stands for the slope that nobody computed: on calm ground the march closes in on the surface from
// above, on steep ground it steps through and comes back (h < 0 steps backwards).
//
// Guarantee: approximate. Stops within the tolerance of a surface, perhaps not of the first one; refined on request
// (Refinement). Other than in its source, used-up steps are reported as exhausted and not as a hit. Source: R. Ma,
// "Heightfield Raycast", procedural_shader_framework; the constants go back to I. Quilez, "Elevated", 2009. Cost: up to
// 300 heights per ray.
#pragma once

#include "scarp/field/height_function.h"
#include "scarp/march/height/height_target.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Closest hit as this march finds it, in [t_min, t_max] and inside the field. A ray that starts on the surface steps
/// off it by one cell without a test. One that starts below the ground is `below`. Uses settings.relaxed and
/// settings.sampling; no pyramid.
Hit march_relaxed(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                  MarchStats* stats = nullptr);
/// The same over a terrain function, within settings.function.reach. Off the surface it steps by 2^-10 of the way out.
Hit march_relaxed(const HeightFunction& function, const Ray& ray, const MarchSettings& settings = {},
                  MarchStats* stats = nullptr, FunctionUse use = FunctionUse::march);

}  // namespace scarp
