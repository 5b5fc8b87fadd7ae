// SPDX-License-Identifier: MIT
// `lipschitz`: sphere tracing of a height field. The vertical distance h to the ground is no distance, but with a bound
// c on the ground's slope h / sqrt(1 + c^2) is one that nothing is nearer than, and a step by it is safe.
//
//            o  h above the ground: the nearest ground can rise towards the ray by c per metre, and no more,
//           /|\                     so a ball of radius h / sqrt(1 + c^2) is free of it
//          / | \      shrink = 1 / sqrt(1 + c^2)
//    _____/__|__\____
//
// c is slope_bound() of the field, the certified slope of the function, or given (settings.lipschitz.shrink). Across a
// hole there is no such bound: the ground may stand at any height on its far side. So no step leaves the largest block
// of the pyramid round the point that has no hole, and over a hole a step goes to the edge of its cell.
//
// Guarantee: conservative. A hit is reported above the ground, within the tolerance; where the ray comes too close to
// go on, it is given up (exhausted). A ray that begins on the surface steps off it by one cell, which is not looked at.
// A ray that begins under the ground is `below`. One that comes in under it through the border goes on (sampling.h), by
// the same factor: it may pass what it is above the ground for less than 2^-12 of a cell. Out of a hole it is given up,
// as it may have touched the rim.
//
// A shrink factor above 1 / sqrt(1 + c^2) makes steps that may pass through the ground, as in shaders whose factor was
// found by trial. The guarantee is then approximate: a sample under the ground is a hit where it lies, so holes and
// halos are seen. Source: J. C. Hart, "Sphere tracing", The Visual Computer 12, 1996; the factor
// for height functions as in the founding text on Lipschitz bounds. Cost: up to 1024 heights per ray, most on steep
// fields, where c is that of the steepest cell.
#pragma once

#include <string>

#include "scarp/field/height_function.h"
#include "scarp/march/guarantee.h"
#include "scarp/march/height/height_target.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// The largest shrink factor that a slope bound c proves: 1 / sqrt(1 + c^2).
double largest_proven_shrink(double slope);
/// What the march promises over ground with this slope bound (NaN: unknown): conservative, or approximate if the
/// settings have a shrink factor that the slope bound does not prove.
Guarantee lipschitz_guarantee(const LipschitzSettings& settings, double slope);
/// A sentence for people about an approximate guarantee, without a full stop; empty if it is conservative.
std::string lipschitz_caveat(const LipschitzSettings& settings, double slope);

/// Closest hit; conventions as in ray.h. Uses settings.lipschitz, and target.slope unless a shrink factor is set there.
/// Throws Error when both are missing.
Hit march_lipschitz(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                    MarchStats* stats = nullptr);
/// The same over a terrain function, within settings.function.reach; rounding counts, and off the surface it steps by
/// 2^-10 of the way out.
Hit march_lipschitz(const HeightFunction& function, const Ray& ray, const MarchSettings& settings = {},
                    MarchStats* stats = nullptr, FunctionUse use = FunctionUse::march);

}  // namespace scarp
