// SPDX-License-Identifier: MIT
// `lipschitz-local`: bounds a terrain function separately on every segment of the ray, so that steps grow where the
// ground is smooth or far below.
//
//     o-------------------+----------o      the ground is below the line mid + slope s + rest on this segment:
//      \ segment of the ray                 free as far as the ray is above that line, or above `high`;
//   ~~~~\~~~~~~~~~~~~~~~~~~~~~~~~~~ high    a free segment is followed by a longer one;
//   ______\______ line + rest ___----       otherwise the ray advances by the free part, and the next is shorter
//      --- ground ---
//
// The line makes this a Newton iteration that cannot overshoot: close to the ground the bounds are of second order. The
// last interval, no longer than the tolerance, is refined to double precision.
//
// Guarantee: conservative, including rounding: it misses no crossing of any function. A hit is a crossing (any of
// several within the tolerance), or a touch: a point where the bounds over a segment of 2^-40 of the ray do not
// separate the ray from the ground. A ray that exceeds the step limit is exhausted, never a hit; one that runs nearly
// along a crease may exceed it. A ray that starts below the ground, or enters below it from beyond kFunctionReach, is
// `below` and is not followed. A ray that starts on the surface is above it by definition: it is followed as far as it
// provably gains height, and hits at its start if it provably loses height there. Source: E. Galin, E. Guerin, A.
// Paris, A. Peytavie, "Segment tracing using local Lipschitz bounds", Computer Graphics Forum 39(2), 2020; here with a
// line and a remainder instead of a slope. Cost: a bound costs as much as 2 to 5 heights.
#pragma once

#include "scarp/base/ray.h"
#include "scarp/field/height_function.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Closest hit. Uses settings.lipschitz_local. Overwrites `stats` unless null: steps counts segment bounds, cell_tests
/// counts heights.
Hit march_lipschitz_local(const HeightFunction& function, const Ray& ray, const MarchSettings& settings = {},
                          MarchStats* stats = nullptr, FunctionUse use = FunctionUse::march);

}  // namespace scarp
