// SPDX-License-Identifier: MIT
// A voxel grid with the accelerator of its march and the colours of its entries.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "scarp/base/edit_count.h"
#include "scarp/march/voxel/voxel_table.h"
#include "scarp/scene/voxel/voxel_material.h"

namespace scarp {

class LatticePlace;  // lattice_place.h

/// Red, green, blue; sRGB.
using VoxelColour = std::array<std::uint8_t, 3>;
/// Colour of voxels without their own.
inline constexpr VoxelColour kPlainVoxels{196, 188, 170};

/// Size in bytes of the accelerator for a grid of this size.
std::int64_t accelerator_bytes(VoxelAccelerator accelerator, const ivec3& size);

/// Throws Error if grids of this size are too large for a march.
void require_marchable(const VoxelMarchEntry& march, const ivec3& size);

/// A scene must be built again after edits of its models, or be edited through a LiveScene (live_scene.h).
class VoxelModel {
 public:
  /// The part of the grid in which rays are traced.
  enum class Extent {
    bounds,  ///< the box around its solid voxels
    grid,    ///< all of it, as in the founding post
  };

  /// Builds what the march, a row of voxel_marches(), needs. Without a palette the entries are RGB, red in the lowest
  /// 8 bits. `materials[i]` is the material of palette entry i; voxels of entries beyond them are plain. Throws Error
  /// if the grid is too large for the march.
  VoxelModel(VoxelGrid grid, const VoxelMarchEntry& march, std::vector<VoxelColour> palette = {},
             Extent extent = Extent::bounds, std::vector<VoxelMaterial> materials = {});
  VoxelModel(VoxelModel&&) noexcept;
  VoxelModel& operator=(VoxelModel&&) noexcept;
  ~VoxelModel();

  /// The same grid, colours and materials with another march.
  VoxelModel marched_by(const VoxelMarchEntry& march) const {
    VoxelModel model(grid_, march, palette_, extent_, materials_);
    model.file_place_ = file_place_;
    return model;
  }

  /// Sets the position of the grid in the voxel coordinates of its file: readers crop grids and rotate their axes.
  void set_file_place(const LatticePlace& place);
  const LatticePlace& file_place() const { return *file_place_; }

  const VoxelGrid& grid() const { return grid_; }
  const VoxelMarchEntry& march() const { return *march_; }
  /// The voxels in which rays are traced; empty if none is solid.
  const VoxelBox& box() const { return box_; }
  VoxelTarget target() const;

  /// Black for entries beyond the palette.
  VoxelColour colour(std::uint32_t entry) const;
  VoxelMaterial material(std::uint32_t entry) const {
    return entry < materials_.size() ? materials_[entry] : VoxelMaterial{};
  }
  /// Whether any of its materials mirrors.
  bool mirrors() const;

  /// Changes the grid and updates its accelerator. `edit(grid)` returns the dirty box; if it throws, the accelerator is
  /// rebuilt over the remaining state.
  template <class Edit>
  void edit(const Edit& edit) {
    VoxelBox changed = grid_.box();
    try {
      changed = edit(grid_);
    } catch (...) {
      update(changed);
      throw;
    }
    update(changed);
  }

  /// Number of edits so far.
  std::uint64_t edits() const { return edits_.value(); }

  /// Memory use, including the accelerator.
  std::size_t bytes() const;

 private:
  void update(const VoxelBox& changed);

  VoxelGrid grid_;
  const VoxelMarchEntry* march_;
  std::vector<VoxelColour> palette_;
  std::vector<VoxelMaterial> materials_;
  Extent extent_;
  std::shared_ptr<const LatticePlace> file_place_;
  VoxelBox box_;
  EditCount edits_;
  struct Accelerator;
  std::unique_ptr<Accelerator> accelerator_;  // what the march needs
};

}  // namespace scarp
