// SPDX-License-Identifier: MIT
// A rotated box, and its overlap test with a triangle or an axis-aligned box (separating axes). Source: S. Gottschalk,
// M. C. Lin, D. Manocha, "OBBTree", SIGGRAPH 1996; T. Akenine-Möller, "Fast 3D triangle-box overlap testing", JGT 6(1),
// 2001. Exact to rounding; a touch is an overlap.
#pragma once

#include <glm/mat3x3.hpp>

#include "scarp/base/vec.h"

namespace scarp {

struct TurnedBox {
  dvec3 centre{0.0};
  dvec3 half{0.0};  ///< half of each side, >= 0
  dmat3 turn{1.0};  ///< a rotation: its columns are the directions of the sides
};

/// Throws Error unless a box is finite, none of its sides is negative and `turn` is a rotation.
void validate(const TurnedBox& box);

/// Returns whether a box and a triangle or an axis-aligned box, both closed, overlap.
bool overlaps(const TurnedBox& box, const Triangle& triangle);
bool overlaps(const TurnedBox& box, const dvec3& low, const dvec3& high);

}  // namespace scarp
