// SPDX-License-Identifier: MIT
// `voxel-exhaustive`: each solid voxel on its own, in rationals. The judge of the voxel marches; it shares no code
// with them, only the quantised ray, which is the question itself.
//
// A voxel is visited when the ray has come into it in all three axes before it leaves it in one:
//
//   max over axes of (s, axis) of the plane into it  <  min over axes of (s, axis) of the plane out of it
//
// compared as pairs: first s = distance / speed, then the axis. A maximum only grows and a minimum only falls with each
// axis, so layers and rows of voxels that two axes already rule out are left as a whole. Guarantee: exact. Cost: the
// rows of the box, and the voxels of those that the ray comes into.
#pragma once

#include "scarp/march/voxel_target.h"

namespace scarp {

VoxelHit march_voxel_exhaustive(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats = nullptr);

}  // namespace scarp
