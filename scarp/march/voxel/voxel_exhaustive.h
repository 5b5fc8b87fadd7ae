// SPDX-License-Identifier: MIT
// `voxel-exhaustive`: tests solid voxels one by one, in rationals. The oracle of the voxel marches; it shares no
// code with them except the quantised ray, which is the query itself.
//
// A voxel is visited if the ray enters it along all three axes before it leaves it along one:
//
//   max over axes of (s, axis) of the entry plane  <  min over axes of (s, axis) of the exit plane
//
// compared as pairs: first s = distance / speed, then the axis. Each axis only raises the maximum and lowers the
// minimum, so a layer excluded by z is skipped as a whole, and so is a row excluded by z and y. Guarantee: exact. Cost:
// the rows of the box, and the voxels of those that remain.
#pragma once

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

VoxelHit march_voxel_exhaustive(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats = nullptr);

}  // namespace scarp
