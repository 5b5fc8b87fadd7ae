// SPDX-License-Identifier: MIT
// Embree 3.13 over the objects of `scarp-bench voxels`, in two ways: the boxes around their solid voxels as user
// geometry, with a march of Scarp in the callback; and the visible faces of one object as triangles, instanced at each
// placement.
#pragma once

#include <memory>
#include <vector>

#include "bench/voxel_engine.h"
#include "scarp/scene/voxel/placed_voxels.h"

namespace scarp::bench {

/// A scene; outlives the engines made from it. Rays of its engines are infinite.
class VoxelEmbreePeer {
 public:
  /// embree-user: the march is that of the model.
  static VoxelEmbreePeer user_geometry(const std::shared_ptr<const VoxelModel>& model, std::vector<VoxelPlace> places);
  /// embree-tri.
  static VoxelEmbreePeer triangles(const VoxelGrid& grid, std::vector<VoxelPlace> places);
  VoxelEmbreePeer(VoxelEmbreePeer&&) noexcept;
  ~VoxelEmbreePeer();

  /// Its modes x1 and x8.
  std::vector<VoxelEngine> engines() const;

 private:
  struct Scene;
  explicit VoxelEmbreePeer(std::unique_ptr<Scene> scene);
  std::unique_ptr<Scene> scene_;
};

}  // namespace scarp::bench
