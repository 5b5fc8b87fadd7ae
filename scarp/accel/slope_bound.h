// SPDX-License-Identifier: MIT
// Maximum slope of a height field: the Lipschitz constant of its height between points that no hole separates.
#pragma once

#include "scarp/field/height_field.h"

namespace scarp {

/// Returns the largest gradient length over all cells that are not holes, metres per metre, with exaggeration; 0
/// without such cells. In a bilinear cell, dz/dx depends only on v and dz/dy only on u, both linearly, so the maximum
/// is at a corner; a triangle has one slope. The bound is attained, up to rounding.
double slope_bound(const HeightField& field);

}  // namespace scarp
