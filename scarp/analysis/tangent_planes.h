// SPDX-License-Identifier: MIT
// Private to scarp/analysis: the tangent planes of nodes, from central differences; at a border or beside a hole from
// one neighbour, and level where there is none. HeightField::shading_normal() takes the same differences, but only
// within cells, which fields of one row or column do not have, and with one length for all cells.
#pragma once

#include <vector>

#include "scarp/analysis/horizon.h"
#include "scarp/analysis/sight.h"
#include "scarp/base/vec.h"
#include "scarp/field/height_field.h"

namespace scarp {

/// The upward normals of a block of nodes, of length 1; 0 on holes. `cells`: lengths in metres.
struct TangentPlanes {
  std::vector<float> east, north, level;

  TangentPlanes() = default;
  TangentPlanes(const HeightField& field, const NodeRect& nodes, const dvec2& cells);
};

/// The upward normal at a place in columns and rows, east, north and up, of length 1, from bilinear heights one cell
/// away: at nodes that of TangentPlanes. The place must have a height.
dvec3 upward_normal(const SightGround& ground, double col, double row);

}  // namespace scarp
