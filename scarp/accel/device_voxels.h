// SPDX-License-Identifier: MIT
// Voxel grids in device memory, each with the accelerator of its march. Shaders read them through voxel_buffers.glsl.h,
// from one address:
//
//   const DeviceVoxels voxels(device, grids);          // grids of a field; objects that share a grid share its memory
//   push.grids = voxels.address();                     // Address in the push constants of the shader
//   VoxelGrids(push.grids).grids[i] ... voxel_mask(...) // in GLSL
//
// Grids share a few large buffers, because drivers limit the number of allocations; blocks that exceed the size limit
// of a buffer are rejected. A grid takes as much memory as on the CPU.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scarp/accel/brick_masks.h"
#include "scarp/accel/empty_cubes.h"
#include "scarp/accel/empty_spheres.h"
#include "scarp/accel/octant_cubes.h"
#include "scarp/accel/voxel_buffers.glsl.h"
#include "scarp/field/voxel_grid.h"
#include "scarp/vk/device.h"
#include "scarp/vk/memory.h"

namespace scarp {

/// A grid with the accelerator of its march: at most one is set; without one, the march is voxel-planes.
struct MarchedGrid {
  const VoxelGrid* grid = nullptr;
  VoxelBox box;  ///< in which rays are followed
  const EmptySpheres* spheres = nullptr;
  const EmptyCubes* cubes = nullptr;
  const OctantCubes* octants = nullptr;
  const BrickMasks* bricks = nullptr;
};

/// Voxel grids in device memory.
class DeviceVoxels {
 public:
  /// Copies the grids. Throws Error if one has more than 2^38 voxels in its box, or if the device lacks memory
  /// (stating the needed and the available size).
  DeviceVoxels(const Device& device, std::span<const MarchedGrid> grids);

  /// Updates grid `index` after an edit that returned `changed`; the accelerator may have changed in `marks`. Copies
  /// only the changed parts, unless pages outgrow their slots.
  void update(std::size_t index, const MarchedGrid& parts, const VoxelBox& changed, const VoxelBox& marks);

  /// Address of the array of ScarpVoxelGrid.
  std::uint64_t address() const { return header_->address(); }
  const std::vector<glsl::ScarpVoxelGrid>& layout() const { return layout_; }
  /// Size on the device, in bytes.
  std::uint64_t bytes() const;

 private:
  enum Block : std::size_t { first_masks, masks, coloured, pages, entries, marks, kBlocks };
  struct Place {
    std::shared_ptr<DeviceBuffer> buffer{};
    std::uint64_t offset = 0, room = 0;  // bytes
  };
  // Position of a page's entries, in words.
  struct Slot {
    std::uint32_t first = 0, room = 0;
  };
  struct Grid {
    std::array<Place, kBlocks> places{};
    std::vector<Slot> slots{};
    std::uint32_t used_words = 0;
  };
  struct Image;

  void place(std::size_t index, const MarchedGrid& parts);
  void copy_all(std::span<Image> images);
  void set_layout(std::size_t index, const MarchedGrid& parts);
  bool grow(Grid& grid, const MarchedGrid& parts, std::size_t stored);

  Device device_;
  std::vector<Grid> grids_;
  std::vector<glsl::ScarpVoxelGrid> layout_;
  std::unique_ptr<DeviceBuffer> header_;
};

}  // namespace scarp
