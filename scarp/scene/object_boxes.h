// SPDX-License-Identifier: MIT
// Private to the station: placements of objects and their boxes, for scenes and for edits of scenes.
#pragma once

#include <cstddef>

#include "scarp/base/world_box.h"
#include "scarp/scene/placement.h"

namespace scarp {

/// This many batch-friendly objects, those with the largest boxes, are queried for all rays; the tree finds the others.
inline constexpr std::size_t kMostBesideTree = 4;

/// Throws Error naming the object unless its placement is a rotation with a finite origin and a scale above 0.
void require_placement(const Placement& placement, std::size_t object);

/// The box around a placed field's box; empty if that is.
WorldBox world_box(const Placement& placement, const WorldBox& box);

}  // namespace scarp
