// SPDX-License-Identifier: MIT
// `exhaustive`: the judge of all other marches. Every cell that the ray's shadow on the ground touches is intersected
// on its own, in double, row by row of the raster, with no accelerator; the pieces are then read in the order of t.
//
// Guarantee: exact (to rounding). Shares no code with the other marches, on purpose: a mistake must not be made twice.
// Cost: O(columns + rows) cells per ray and a sort; hundreds of times slower than max-mip. For tests and error
// pictures.
#pragma once

#include <vector>

#include "scarp/march/height/height_target.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Closest hit; conventions as in ray.h. The pyramid is not used. In a field that wraps round t_max must be finite.
Hit march_exhaustive(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                     MarchStats* stats = nullptr);

/// All hits in the ray's range, in the order of t, as all_hits_max_mip gives them. Returns hit, or why there is none.
HitStatus all_hits_exhaustive(const HeightTarget& target, const Ray& ray, std::vector<Hit>& hits);

}  // namespace scarp
