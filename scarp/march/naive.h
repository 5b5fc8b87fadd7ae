// SPDX-License-Identifier: MIT
// `naive`: steps by the vertical distance h between ray and ground, never less than a fraction of the ray's length; it
// hits where h is small, with a tolerance that grows with distance.
//
//   t = t_enter;   h = ray height - ground;   h < tolerance * t: hit;   t += max(step_factor * |h|, min_step * t_exit)
//
// t and t_exit, where the ray leaves the field, count from t_min here: the distance travelled, and its maximum.
// SamplingSettings::tolerance is a height that counts as a hit at any distance. A ray from the surface starts within
// it: its steps are no shorter than this height, and it hits only where it is deeper below ground.
//
// The hit is refined on request (Refinement): `secant`, of I. Quilez, "Rainforest", 2016, draws a straight line through
// the last two clearances, and ends where it reaches the tolerance, not the ground.
//
// Guarantee: approximate. The vertical distance is an overestimate: rays step over steep ground (holes in the picture),
// and rays that graze the ground stop before it. This is the baseline of the max-mip article, in which this march took
// 55.066 ms and max-mip 9.074 ms. Cost: at most 1 / min_step forced steps, plus those determined by h; one height per
// step.
#pragma once

#include "scarp/field/height_function.h"
#include "scarp/march/height/height_target.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Returns the closest hit that this march finds. t is in the ray's range and inside the field; `height` is the height
/// of the ray's point there. A ray that starts below the ground hits at its start. A ray that starts on the surface
/// takes its first step without a test. Uses settings.naive and settings.sampling; no pyramid.
Hit march_naive(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                MarchStats* stats = nullptr);
/// The same over a terrain function, within settings.function.reach.
Hit march_naive(const HeightFunction& function, const Ray& ray, const MarchSettings& settings = {},
                MarchStats* stats = nullptr, FunctionUse use = FunctionUse::march);

}  // namespace scarp
