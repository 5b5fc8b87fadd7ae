// SPDX-License-Identifier: MIT
// `exhaustive`: the oracle of all other marches. Intersects every cell below the ray independently, in double, row
// by row of the raster, without an accelerator; then reads the pieces in order of t.
//
// Guarantee: exact (to rounding). Deliberately shares no code with the other marches, so that no mistake is made twice.
// Cost: O(columns + rows) cells per ray and a sort; hundreds of times slower than max-mip. For tests and error images.
#pragma once

#include <vector>

#include "scarp/march/height/height_target.h"
#include "scarp/march/hit_rules.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Closest hit; conventions as in ray.h. Does not use the pyramid. In a wrapped field t_max must be finite.
Hit march_exhaustive(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                     MarchStats* stats = nullptr);

/// Closest of the hits that count, as for march_max_mip_by_rules().
Hit march_exhaustive_by_rules(const HeightTarget& target, const Ray& ray, const HitRules& rules,
                              MarchStats* stats = nullptr);

/// All hits in the ray's range, in order of t, as for all_hits_max_mip(). Returns `hit`, or why there is none.
HitStatus all_hits_exhaustive(const HeightTarget& target, const Ray& ray, std::vector<Hit>& hits);
/// The same for hits from below.
HitStatus all_hits_from_below_exhaustive(const HeightTarget& target, const Ray& ray, std::vector<Hit>& hits);

}  // namespace scarp
