// SPDX-License-Identifier: MIT
#include "scarp/accel/empty_spheres.h"

#include "scarp/accel/sphere_rows.h"

namespace scarp {
namespace {

// Whether a solid voxel of the box has become empty.
bool any_removed(const VoxelNearness& solid, const VoxelBox& box, const VoxelBytes& distances) {
  unsigned removed = 0;
  for_each_row(box, [&](int y, int z) {
    const std::uint8_t* const now = solid.row(y - box.low.y, z - box.low.z);
    const std::uint8_t* const before = distances.at({box.low.x, y, z});
    for (int x = 0; x < box.high.x - box.low.x; ++x) removed |= before[x] == EmptySpheres::kSolid && now[x] == 0;
  });
  return removed != 0;
}

}  // namespace

EmptySpheres::EmptySpheres(const VoxelGrid& grid) : distances_(glm::min(grid.size(), kMaxAcceleratedSide), kFarthest) {
  require_accelerable(grid.size(), "empty spheres");
  if (grid.solid_count() > 0) build(grid, {grid.box(), grid.box()});
}

void EmptySpheres::update(const VoxelGrid& grid, const VoxelBox& changed) {
  const VoxelBox box = intersection(changed, grid.box());
  if (box.empty()) return;
  if (grid.solid_count() == 0) {
    distances_ = VoxelBytes(distances_.size(), kFarthest);
    return;
  }
  const SphereEdit edit = find_spheres(box, distances_);
  if (!any_removed(VoxelNearness(grid, box), box, distances_)) {
    // Distances can only decrease, and only because of voxels in the box, which count as dilated by one.
    VoxelBox rows = intersection(box.grown(1), grid.box());
    rows.low.x = edit.region.low.x, rows.high.x = edit.region.high.x;
    build(grid, {rows, edit.region, &box, true});
    return;
  }
  // A window that is too small never underestimates distances, so its results determine a sufficient window.
  const auto window = [&](int farthest) { return intersection(edit.region.grown(farthest + 2), grid.box()); };
  const int found = build(grid, {window(edit.most), edit.region, &box});
  if (found > edit.most) build(grid, {window(found), edit.region, &box});
}

int EmptySpheres::build(const VoxelGrid& grid, const SphereRows& rows) {
  VoxelNearness near(grid, rows.window);
  near.along_x({});
  return build_spheres(near, rows, distances_);
}

}  // namespace scarp
