// SPDX-License-Identifier: MIT
// Voxels: a grid with its accelerator and colours, ready for rays.
//
//   const auto voxels = scarp::Voxels::copy(indices, {64, 64, 32}, {.side = 0.5, .palette = colours});
//   const scarp::Hit hit = scarp::cast(voxels, ray);
//
// Voxels convert to a Scene with one field. Queries use the march `voxel-bricks`, which is exact. World space is
// right-handed, in metres, z up. The grid's corner (0, 0, 0) is at the origin; voxel v is the cube from v * side to
// (v + 1) * side.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "scarp/field/voxel_grid.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/voxel/voxel_model.h"

namespace scarp {

struct VoxelSettings {
  double side = 1;  ///< side of a voxel in metres, > 0
  /// palette[i] is the colour of voxels with the entry i; entries beyond it are black. If it is empty, the entries of a
  /// grid are 24-bit RGB colours, with red in the lowest 8 bits.
  std::vector<VoxelColour> palette{};
};

/// A voxel grid with its accelerator. Copies are cheap and share their state, edits included. Thread-safe for queries,
/// but not during edit(); to edit while other threads query, use LiveScene (scarp/scene/live_scene.h).
class Voxels {
 public:
  /// Copies a volume of palette indices, one byte per voxel: x fastest, then y, then z; 0 is empty. Each side has 1 to
  /// VoxelGrid::kMaxSide voxels. With an empty palette, all voxels have the colour kPlainVoxels. Throws Error for a
  /// null pointer, a size or setting out of range, or an index beyond the palette.
  static Voxels copy(const std::uint8_t* indices, const ivec3& size, VoxelSettings settings = {});
  /// Takes a grid and builds its accelerator. Throws Error for a setting out of range.
  explicit Voxels(VoxelGrid grid, VoxelSettings settings = {});

  /// Calls `change` with the grid, then updates the accelerator. `change` must return a box around all voxels that it
  /// changed, as every edit of VoxelGrid does:
  ///
  ///     voxels.edit([](scarp::VoxelGrid& grid) { return grid.clear_sphere({32, 32, 16}, 6); });
  void edit(const std::function<VoxelBox(VoxelGrid&)>& change);

  const VoxelGrid& grid() const;
  /// Returns the colour of a voxel that was hit.
  VoxelColour colour(const Hit& hit) const;

  /// Returns the scene of these voxels alone. After an edit, other scenes that contain them throw Error until they are
  /// combined again; a LiveScene supports edits.
  const Scene& scene() const;
  operator const Scene&() const { return scene(); }

 private:
  struct State;

  std::shared_ptr<State> state_;
};

}  // namespace scarp
