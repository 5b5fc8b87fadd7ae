// SPDX-License-Identifier: MIT
// `voxel-exhaustive`: solid voxels one by one, in rationals. The judge of the voxel marches; it shares no code with
// them, only the quantised ray, which is the question itself.
//
// A voxel is visited when the ray has come into it in all three axes before it leaves it in one:
//
//   max over axes of (s, axis) of the plane into it  <  min over axes of (s, axis) of the plane out of it
//
// compared as pairs: first s = distance / speed, then the axis. The maximum only grows and the minimum only falls with
// each axis, so a layer that z rules out is left as a whole, and so is a row that z and y rule out. Guarantee: exact.
// Cost: the rows of the box, and the voxels of those that are left.
#pragma once

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

VoxelHit march_voxel_exhaustive(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats = nullptr);

}  // namespace scarp
