// SPDX-License-Identifier: MIT
// `lipschitz-local` with a filter: behind a rejected hit the ray continues below the ground until it emerges.
//
//        \        rejected     __              below the ground the march runs over the ground upside down, where
//   ______\____      ^     ___/  \___          emerging is a hit from above; each part starts on the surface by the
//          \   `-----x----o----- \----.        march's own rule
//           rejected ^   out      ^ next hit
//
// Guarantee: that of lipschitz_local.h for each part. Two hits within its tolerance may reach the filter as one, or one
// hit may reach it twice.
#pragma once

#include "scarp/march/function/lipschitz_local.h"
#include "scarp/march/hit_rules.h"

namespace scarp {

/// Returns the function times -1. Throws Error if that is too large to compile.
HeightFunction upside_down(const HeightFunction& function);

/// Returns the closest hit that the filter accepts. `below` is upside_down(function). The step limit is that of the
/// whole ray; `stats` as for march_lipschitz_local().
Hit march_lipschitz_local_filtered(const HeightFunction& function, const HeightFunction& below, const Ray& ray,
                                   const HitFilter& accept, const MarchSettings& settings, MarchStats* stats);

}  // namespace scarp
