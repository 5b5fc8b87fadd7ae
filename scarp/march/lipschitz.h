// SPDX-License-Identifier: MIT
// `lipschitz`: sphere tracing of a height field. The vertical distance h overestimates the distance to the ground, but
// with a bound c on the ground's slope no ground is nearer than h / sqrt(1 + c^2), so a step of that length is safe.
//
//            o  h above the ground: the nearest ground can rise towards the ray by c per metre, and no more,
//           /|\                     so a ball of radius h / sqrt(1 + c^2) is free of it
//          / | \      shrink = 1 / sqrt(1 + c^2)
//    _____/__|__\____
//
// c is slope_bound() of the field, the certified slope of the function, or given (settings.lipschitz.shrink). This
// bound does not hold across a hole: the ground may have any height on its far side. Steps therefore stay within the
// largest hole-free block of the pyramid around the point; over a hole a step ends at the edge of its cell.
//
// Guarantee: conservative. A hit is reported above the ground, within the tolerance; a ray that comes too close to
// advance is exhausted. A ray that starts on the surface steps off it by one cell without a test. A ray that starts
// below the ground is `below`. A ray that enters below it through the border is followed (sampling.h) with the same
// factor; it may skip stretches above the ground that are shorter than 2^-12 of a cell. A ray that enters below the
// ground from a hole is exhausted, because it may have touched the rim.
//
// With a shrink factor above 1 / sqrt(1 + c^2), steps may pass through the ground, as in shaders whose factor was found
// by trial. The guarantee is then approximate: the first sample below the ground is the hit, which shows holes and
// halos. Source: J. C. Hart, "Sphere tracing", The Visual Computer 12, 1996; the factor
// for height functions as in the founding text on Lipschitz bounds. Cost: up to 1024 heights per ray, most on steep
// fields, where c is that of the steepest cell.
#pragma once

#include <string>

#include "scarp/field/height_function.h"
#include "scarp/march/guarantee.h"
#include "scarp/march/height/height_target.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Returns the largest shrink factor that a slope bound c proves: 1 / sqrt(1 + c^2).
double largest_proven_shrink(double slope);
/// Returns the guarantee over ground with this slope bound (NaN: unknown): approximate if the settings have a shrink
/// factor that the slope bound does not prove, else conservative.
Guarantee lipschitz_guarantee(const LipschitzSettings& settings, double slope);
/// Returns a message for users if the guarantee is approximate, without a full stop; empty if it is conservative.
std::string lipschitz_caveat(const LipschitzSettings& settings, double slope);

/// Closest hit; conventions as in ray.h. Uses settings.lipschitz, and target.slope unless a shrink factor is set there.
/// Throws Error when both are missing.
Hit march_lipschitz(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                    MarchStats* stats = nullptr);
/// The same over a terrain function, within settings.function.reach, including rounding. Rays that start on the surface
/// first step by 2^-10 of the exit distance.
Hit march_lipschitz(const HeightFunction& function, const Ray& ray, const MarchSettings& settings = {},
                    MarchStats* stats = nullptr, FunctionUse use = FunctionUse::march);

}  // namespace scarp
