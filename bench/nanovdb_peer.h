// SPDX-License-Identifier: MIT
// NanoVDB 32 over the same voxels: a grid of floats, 1 where a voxel is solid, followed by its own hierarchical DDA
// from active node to active voxel, one ray at a time, in float, as in its documentation.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "bench/voxel_engine.h"
#include "scarp/field/voxel_grid.h"

namespace scarp::bench {

class NanovdbPeer {
 public:
  explicit NanovdbPeer(const VoxelGrid& grid);
  /// Sets a solid voxel. `fill` calls it for each.
  using Set = std::function<void(const ivec3& voxel, float value)>;
  explicit NanovdbPeer(const std::function<void(const Set&)>& fill);
  NanovdbPeer(NanovdbPeer&&) noexcept;
  ~NanovdbPeer();

  /// Rays are in the space of the grid. The modes are the distances by which the point that selects the next voxel is
  /// pushed across a border: NanoVDB's own 1.0001 voxels, or a ten-thousandth. The peer outlives its engines.
  std::vector<VoxelEngine> engines() const;

 private:
  struct Tree;
  VoxelEngine engine(const char* mode, float push) const;

  std::unique_ptr<Tree> tree_;
};

}  // namespace scarp::bench
