// SPDX-License-Identifier: MIT
// The loop of all voxel marches, which differ in how far they advance at once.
#pragma once

#include "scarp/march/voxel/voxel_walk.h"

namespace scarp {

/// `advance(walk, voxel, solid)` sets `solid`, or advances and returns whether the ray is still in the box.
/// `found(walk)` returns the answer for the solid voxel at the current position.
template <class Advance, class Found, class Answer>
Answer walk_voxels(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats, Advance advance,
                   const Found& found, Answer missed) {
  VoxelWalk walk(ray, target.box);
  std::uint32_t steps = 0;
  bool solid = false;
  for (;;) {
    const bool inside = advance(walk, walk.voxel(), solid);
    if (solid) {
      if (stats) *stats = {steps, 0, 1};
      return found(walk);
    }
    ++steps;
    if (!inside) break;
  }
  if (stats) *stats = {steps, 0, 0};
  return missed;
}

template <class Advance>
VoxelHit first_voxel(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats, Advance advance) {
  return walk_voxels(
      target, ray, stats, advance, [&](const VoxelWalk& walk) { return walk.hit(*target.grid); }, VoxelHit{});
}

template <class Advance>
bool any_voxel(const VoxelTarget& target, const QuantisedRay& ray, Advance advance) {
  return walk_voxels(
      target, ray, nullptr, advance, [&](const VoxelWalk& walk) { return walk.in_range(); }, false);
}

}  // namespace scarp
