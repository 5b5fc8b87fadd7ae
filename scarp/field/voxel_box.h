// SPDX-License-Identifier: MIT
// Boxes of voxels.
#pragma once

#include <glm/common.hpp>

#include "scarp/base/vec.h"

namespace scarp {

/// The voxels low <= v < high. Voxel v is the cube from v to v + 1 along each axis.
struct VoxelBox {
  ivec3 low{0};
  ivec3 high{0};

  bool empty() const { return low.x >= high.x || low.y >= high.y || low.z >= high.z; }
  bool contains(const ivec3& v) const {
    return v.x >= low.x && v.y >= low.y && v.z >= low.z && v.x < high.x && v.y < high.y && v.z < high.z;
  }
  /// Returns the box enlarged by `voxels` on all sides.
  VoxelBox grown(int voxels) const { return {low - voxels, high + voxels}; }
  friend bool operator==(const VoxelBox&, const VoxelBox&) = default;
};

inline VoxelBox intersection(const VoxelBox& a, const VoxelBox& b) {
  return {glm::max(a.low, b.low), glm::min(a.high, b.high)};
}

/// Returns the smallest box around both; ignores empty boxes.
inline VoxelBox around(const VoxelBox& a, const VoxelBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

/// Calls body(y, z) for each row along x.
template <class Body>
void for_each_row(const VoxelBox& box, const Body& body) {
  for (int z = box.low.z; z < box.high.z; ++z) {
    for (int y = box.low.y; y < box.high.y; ++y) body(y, z);
  }
}

/// Calls body(v) for each voxel, x fastest.
template <class Body>
void for_each_voxel(const VoxelBox& box, const Body& body) {
  for (int z = box.low.z; z < box.high.z; ++z) {
    for (int y = box.low.y; y < box.high.y; ++y) {
      for (int x = box.low.x; x < box.high.x; ++x) body(ivec3(x, y, z));
    }
  }
}

}  // namespace scarp
