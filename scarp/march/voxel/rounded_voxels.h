// SPDX-License-Identifier: MIT
// Voxels with rounded edges: the first point where a ray hits a solid voxel whose cube is rounded.
//
//   +-----------+      the cube of a voxel, inset by the radius on each face that has no solid voxel behind it, then
//   |  .-----.  |      dilated by the radius, clipped to the cube: a ball rolled along its edges.
//   | |       | |      Faces between two solid voxels stay: walls are flat, steps meet, and no gaps open
//   +-----------+      between neighbours. Edges that touch an edge of another voxel stay sharp, so that rays that
//                      cubes block are blocked. `each`: every voxel is rounded on all sides, like a heap of dice
//
// Guarantee: the traversal from voxel to voxel is that of the march, exact. In a voxel the squared distance to the
// inner box is a parabola between the planes of that box, and its first root is taken: t is accurate to a few roundings
// of double, and a ray that grazes an edge by less may pass or hit. A ray that passes a voxel's edge continues in the
// neighbour behind the face by which it leaves (decided in double; ties in the order x, y, z), quantised again from the
// original ray: nothing accumulates. Source: rounded boxes as in I. Quilez, "Distance functions".
#pragma once

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

/// Returns the first rounded voxel that counts, using a march that finds the first solid one; without `accept`, all
/// voxels count. `from`: the voxel on whose surface the ray starts and which it leaves, or null. The face is the one
/// nearest to the surface normal; `inside` for a ray that starts in the rounded voxel. Overwrites `stats` unless null.
VoxelHit first_rounded_voxel(const VoxelTarget& target, VoxelMarch march, const VoxelRay& ray,
                             const VoxelDirection& direction, const VoxelRounding& rounding, const ivec3* from,
                             MarchStats* stats, const VoxelFilter* accept = nullptr);

/// Returns the outward unit normal at a surface point, in the grid's space; zero for `inside`.
dvec3 rounded_normal(const VoxelGrid& grid, const ivec3& voxel, VoxelFace face, const dvec3& point,
                     const VoxelRounding& rounding);

}  // namespace scarp
