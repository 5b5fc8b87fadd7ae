// SPDX-License-Identifier: MIT
// Edits of voxel grids with balls.
#include <algorithm>
#include <cmath>

#include "scarp/field/voxel_grid.h"

namespace scarp {
namespace {

// Voxels within reach of a ball, clipped to a grid so that coordinates fit in int.
VoxelBox box_of_ball(const dvec3& centre, double radius, const VoxelBox& inside) {
  VoxelBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = inside.low[axis], high = inside.high[axis];
    box.low[axis] = static_cast<int>(std::clamp(std::floor(centre[axis] - radius), low, high));
    box.high[axis] = static_cast<int>(std::clamp(std::ceil(centre[axis] + radius), low, high));
  }
  return box;
}

bool in_ball(const ivec3& voxel, const dvec3& centre, double radius) {
  const dvec3 from_centre = dvec3(voxel) + 0.5 - centre;
  return radius >= 0 && dot(from_centre, from_centre) <= radius * radius;
}

}  // namespace

VoxelBox VoxelGrid::fill_sphere(const dvec3& centre, double radius, std::uint32_t entry) {
  require_entry(entry);
  return edit(box_of_ball(centre, radius, box()), [&](const ivec3& voxel, const Voxel& before) {
    return in_ball(voxel, centre, radius) ? Voxel(entry) : before;
  });
}

VoxelBox VoxelGrid::clear_sphere(const dvec3& centre, double radius) {
  return edit(box_of_ball(centre, radius, box()), [&](const ivec3& voxel, const Voxel& before) {
    return in_ball(voxel, centre, radius) ? Voxel() : before;
  });
}

VoxelBox VoxelGrid::paint_sphere(const dvec3& centre, double radius, std::uint32_t entry) {
  require_entry(entry);
  return edit(box_of_ball(centre, radius, box()), [&](const ivec3& voxel, const Voxel& before) {
    return before && in_ball(voxel, centre, radius) ? Voxel(entry) : before;
  });
}

}  // namespace scarp
