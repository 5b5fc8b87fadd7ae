// SPDX-License-Identifier: MIT
// Private to scarp/analysis: the tangent planes of nodes, from central differences; at a border or beside a hole from
// one neighbour, and level where there is none.
#pragma once

#include <vector>

#include "scarp/analysis/map_part.h"
#include "scarp/field/height_field.h"

namespace scarp {

/// The upward normals of a band of rows, of length 1; 0 on holes.
struct TangentPlanes {
  std::vector<float> east, north, level;

  TangentPlanes() = default;
  TangentPlanes(const HeightField& field, const RowBand& band);
};

}  // namespace scarp
