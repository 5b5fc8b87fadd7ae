// SPDX-License-Identifier: MIT
// `relaxed`: the march of many terrain shaders. t += 0.4 * h, a hit where |h| < 0.0015 * t, 300 steps; t counts from
// t_min.
//
// The factor below 1 stands in for the unknown slope: on gentle ground the march approaches the surface from above; on
// steep ground it steps through and returns (h < 0 steps backwards).
//
// Guarantee: approximate. Stops within the tolerance of a surface, which may not be the first one; refined on request
// (Refinement). Unlike its source, it reports the step limit as exhausted, not as a hit. Source: R. Ma, "Heightfield
// Raycast", procedural_shader_framework; the constants go back to I. Quilez, "Elevated", 2009. Cost: up to 300 heights
// per ray.
#pragma once

#include "scarp/field/height_function.h"
#include "scarp/march/height/height_target.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Returns the closest hit that this march finds, in [t_min, t_max] and inside the field. A ray that starts on the
/// surface steps off it by one cell without a test. A ray that starts below the ground is `below`. Uses
/// settings.relaxed and settings.sampling; no pyramid.
Hit march_relaxed(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                  MarchStats* stats = nullptr);
/// The same over a terrain function, within settings.function.reach. Rays that start on the surface first step by 2^-10
/// of the exit distance.
Hit march_relaxed(const HeightFunction& function, const Ray& ray, const MarchSettings& settings = {},
                  MarchStats* stats = nullptr, FunctionUse use = FunctionUse::march);

}  // namespace scarp
