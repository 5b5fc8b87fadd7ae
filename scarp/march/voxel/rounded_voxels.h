// SPDX-License-Identifier: MIT
// Voxels with rounded edges: which point of a solid voxel a ray meets first, when only part of its cube is there.
//
//   +-----------+      the cube of a voxel, moved in by the radius on each face that has no solid voxel behind it,
//   |  .-----.  |      and then grown by the radius again, as far as the cube reaches: a ball's way round its edges.
//   | |       | |      Faces between two solid voxels stay: walls are flat, steps meet, nothing opens between
//   +-----------+      neighbours, and edges that touch another voxel's stay sharp, so that rays that cubes stop are
//                      stopped. `each`: every voxel is rounded on all sides, as a heap of dice
//
// Guarantee: the walk from voxel to voxel is that of the march, exact; in a voxel the distance to the inner box is a
// parabola between the planes of that box, of which the first root is taken: t to some roundings of double, and a ray
// that grazes an edge by less may pass or hit. A ray that passes a voxel's edge goes on from the neighbour by whose
// face it leaves (told in double, of equals x before y before z), quantised anew from itself: nothing accumulates.
// Source: rounded boxes as in I. Quilez, "Distance functions".
#pragma once

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

struct VoxelRounding {
  double radius = 0;  ///< of edges and corners, in sides of a voxel: 0 (cubes) to 0.5 (a lone voxel is a ball)
  bool each = false;  ///< every voxel on its own

  explicit operator bool() const { return radius > 0; }
};

/// Throws Error naming the setting out of its range.
void validate(const VoxelRounding& rounding);

/// The first rounded voxel, by a march that finds the first solid one. `from`: the voxel on whose surface the ray
/// begins and which it leaves, or null. The face is the one that the surface there looks most along; `inside` for a ray
/// that begins in the rounded voxel. `stats`, when given, is overwritten.
VoxelHit first_rounded_voxel(const VoxelTarget& target, VoxelMarch march, const VoxelRay& ray,
                             const VoxelDirection& direction, const VoxelRounding& rounding, const ivec3* from,
                             MarchStats* stats);

/// Outward unit normal at a point of the surface, in the grid's space; zero for `inside`.
dvec3 rounded_normal(const VoxelGrid& grid, const VoxelHit& hit, const dvec3& point, const VoxelRounding& rounding);

}  // namespace scarp
