// SPDX-License-Identifier: MIT
// Voxels: a grid with its accelerator and colours, ready for rays.
//
//   const auto voxels = scarp::Voxels::copy(indices, {64, 64, 32}, {.side = 0.5, .palette = colours});
//   const scarp::Hit hit = scarp::cast(voxels, ray);
//
// Voxels are a scene of one field: they can be passed wherever a Scene is expected. Rays are answered by
// `voxel-bricks`, which is exact. World space is right-handed, in metres, z up; the grid's corner (0, 0, 0) is at the
// origin, and voxel v is the cube from v * side to (v + 1) * side.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "scarp/field/voxel_grid.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/voxel_model.h"

namespace scarp {

struct VoxelSettings {
  double side = 1;  ///< of a voxel, metres, > 0
  /// palette[i] is the colour of voxels with the entry i. Without one, entries of a grid are RGB in 24 bits, red
  /// lowest.
  std::vector<VoxelColour> palette{};
};

/// A voxel grid with its accelerator. Copies are cheap and are the same voxels. May be queried from many threads at
/// once, but not during edit().
class Voxels {
 public:
  /// Copies a volume of palette indices, one byte per voxel: x fastest, then y, then z; 0 is empty. Each side is 1 to
  /// VoxelGrid::kMaxSide. Without a palette all voxels have the colour kPlainVoxels. Throws Error for a null pointer, a
  /// size or setting out of range, an index beyond the palette.
  static Voxels copy(const std::uint8_t* indices, const ivec3& size, VoxelSettings settings = {});
  /// Builds the accelerator of a grid, which the program filled with set(), fill(), fill_sphere(), ... Throws Error for
  /// a setting out of range.
  explicit Voxels(VoxelGrid grid, VoxelSettings settings = {});

  /// Calls `change` with the grid, and updates the accelerator. `change` returns the box of voxels that it changed, as
  /// every edit of VoxelGrid does:
  ///
  ///     voxels.edit([](scarp::VoxelGrid& grid) { return grid.clear_sphere({32, 32, 16}, 6); });
  void edit(const std::function<VoxelBox(VoxelGrid&)>& change);

  const VoxelGrid& grid() const;
  /// Colour of a voxel that was hit.
  VoxelColour colour(const Hit& hit) const;

  /// The scene of these voxels alone. Scenes that were combined from it before an edit must be combined again.
  const Scene& scene() const;
  operator const Scene&() const { return scene(); }

 private:
  struct State;

  std::shared_ptr<State> state_;
};

}  // namespace scarp
