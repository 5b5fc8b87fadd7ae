// SPDX-License-Identifier: MIT
// Private to the station: placements of objects and their boxes, for scenes and for edits of scenes.
#pragma once

#include <cstddef>

#include "scarp/base/world_box.h"
#include "scarp/scene/placement.h"

namespace scarp {

/// Number of batch-friendly objects, those with the largest boxes, that are queried for all rays. The tree finds the
/// others.
inline constexpr std::size_t kMostBesideTree = 4;

/// Throws Error naming the object unless its placement is a rotation with a finite origin and a scale above 0.
void require_placement(const Placement& placement, std::size_t object);

/// The box around a field's box after placement; empty if that box is empty.
WorldBox world_box(const Placement& placement, const WorldBox& box);

/// The largest coordinate from which a ray's position in an object is computed, in metres in world space. `in_field` is
/// SceneField::farthest_voxel(), `extent` the object's box. 0 if `in_field` is 0: rounding does not matter then.
double farthest_of(const Placement& placement, double in_field, const WorldBox& extent);
/// The room, in metres, of rays in a scene with voxels whose farthest_of() is at most `farthest`: Ray::room times the
/// scale of their object. A power of two, so that few moves of objects change it.
double room_of_voxels(double farthest);

}  // namespace scarp
