// SPDX-License-Identifier: MIT
// The loop of all voxel marches, which differ in how far they advance at once.
#pragma once

#include "scarp/base/march_trace.h"
#include "scarp/march/voxel/voxel_walk.h"

namespace scarp {

/// A walk that records what it skips.
class TracedWalk : public VoxelWalk {
 public:
  TracedWalk(const QuantisedRay& ray, const VoxelBox& box, MarchTrace& trace) : VoxelWalk(ray, box), trace_(trace) {}

  bool step() {
    note(TraceKind::voxel, voxel(), 1);
    return arrive(VoxelWalk::step());
  }
  bool leave(const VoxelBox& part) {
    note(TraceKind::cube, part.low, part.high.x - part.low.x);
    return arrive(VoxelWalk::leave(part));
  }
  bool step_and_travel(std::int64_t voxels, std::int64_t travel_per_voxel) {
    note(TraceKind::sphere, voxel(), static_cast<int>(voxels));
    return arrive(VoxelWalk::step_and_travel(voxels, travel_per_voxel));
  }
  VoxelHit hit(const VoxelGrid& grid) const {
    note(TraceKind::solid, voxel(), 1);
    return VoxelWalk::hit(grid);
  }

 private:
  void note(TraceKind kind, const ivec3& low, int size) const {
    TraceStep step{.kind = kind, .t = t(), .t_out = t()};
    step.voxel = voxel(), step.low = low, step.size = size;
    trace_.steps.push_back(step);
  }
  bool arrive(bool inside) {
    trace_.steps.back().t_out = t();
    return inside;
  }

  MarchTrace& trace_;
};

/// `advance(walk, voxel, solid)` sets `solid`, or advances and returns whether the ray is still in the box.
/// `found(walk)` returns the answer for the solid voxel at the current position. `trace`: of a TracedWalk.
template <class Walk = VoxelWalk, class Advance, class Found, class Answer, class... Trace>
Answer walk_voxels(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats, Advance advance,
                   const Found& found, Answer missed, Trace&... trace) {
  Walk walk(ray, target.box, trace...);
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

/// The same, recorded: adds to `trace`.
template <class Advance>
VoxelHit traced_voxel(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats, MarchTrace& trace,
                      Advance advance) {
  return walk_voxels<TracedWalk>(
      target, ray, stats, advance, [&](const TracedWalk& walk) { return walk.hit(*target.grid); }, VoxelHit{}, trace);
}

template <class Advance>
bool any_voxel(const VoxelTarget& target, const QuantisedRay& ray, Advance advance) {
  return walk_voxels(
      target, ray, nullptr, advance, [&](const VoxelWalk& walk) { return walk.in_range(); }, false);
}

}  // namespace scarp
