// SPDX-License-Identifier: MIT
// Placement of a grid on a lattice shared with other grids: quarter turns and whole-voxel offsets.
#pragma once

#include <glm/common.hpp>

#include "scarp/base/lattice_rotation.h"
#include "scarp/field/voxel_box.h"

namespace scarp {

class LatticePlace {
 public:
  /// origin: position of the grid's corner (0, 0, 0) on the lattice.
  LatticePlace(const LatticeRotation& turn, const ivec3& origin)
      : turn_(turn), back_(turn.inverse()), origin_(origin) {}

  const LatticeRotation& turn() const { return turn_; }
  const ivec3& origin() const { return origin_; }

  // Voxels are mapped by their centres; doubled, these are integers.

  /// The voxel of the grid that covers a voxel of the lattice.
  ivec3 grid_voxel(const ivec3& v) const { return (back_(2 * (v - origin_) + 1) - 1) / 2; }
  /// The voxel of the lattice that a voxel of the grid covers.
  ivec3 lattice_voxel(const ivec3& v) const { return (turn_(2 * v + 1) - 1) / 2 + origin_; }
  /// A box of the grid on the lattice; empty if the box is empty.
  VoxelBox lattice_box(const VoxelBox& box) const {
    if (box.empty()) return {};
    const ivec3 a = turn_(box.low) + origin_, b = turn_(box.high) + origin_;
    return {glm::min(a, b), glm::max(a, b)};
  }

 private:
  LatticeRotation turn_, back_;
  ivec3 origin_;
};

}  // namespace scarp
