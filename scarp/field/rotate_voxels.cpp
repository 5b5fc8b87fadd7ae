// SPDX-License-Identifier: MIT
#include "scarp/field/rotate_voxels.h"

namespace scarp {

ivec3 rotated_voxel(const ivec3& voxel, const ivec3& size, const LatticeRotation& turn) {
  ivec3 at;
  for (int i = 0; i < 3; ++i) {
    const int along = voxel[turn.axis[i]];
    at[i] = turn.sign[i] > 0 ? along : size[turn.axis[i]] - 1 - along;
  }
  return at;
}

VoxelGrid rotated(const VoxelGrid& grid, const LatticeRotation& turn) {
  const ivec3 size(grid.size()[turn.axis[0]], grid.size()[turn.axis[1]], grid.size()[turn.axis[2]]);
  VoxelGrid result(size, grid.entry_bits());
  const LatticeRotation back = turn.inverse();
  result.edit(result.box(), [&](const ivec3& voxel, const VoxelGrid::Voxel&) {
    const ivec3 from = rotated_voxel(voxel, size, back);
    return grid.solid(from) ? VoxelGrid::Voxel(grid.entry(from)) : VoxelGrid::Voxel();
  });
  return result;
}

}  // namespace scarp
