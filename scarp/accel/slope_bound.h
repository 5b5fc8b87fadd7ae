// SPDX-License-Identifier: MIT
// The steepest slope of a height field: the Lipschitz constant of its height, wherever no hole lies between.
#pragma once

#include "scarp/field/height_field.h"

namespace scarp {

/// Largest length of the surface's gradient over all cells that are no holes, metres per metre, exaggerated; 0 without
/// such cells. In a bilinear cell dz/dx depends on v alone and dz/dy on u alone, both linearly, so the largest length
/// is found at a corner; a triangle has one slope. The bound is attained, but for rounding.
double slope_bound(const HeightField& field);

}  // namespace scarp
