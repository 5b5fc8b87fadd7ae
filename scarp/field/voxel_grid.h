// SPDX-License-Identifier: MIT
// A dense voxel grid: solidity, and a colour entry for each solid voxel.
//
//   shape   one bit per voxel, in bricks of 4 x 4 x 4: a 64-bit mask, bit x + 4 y + 16 z
//   bricks  x fastest, then y, then z; if a side is not a multiple of 4, the last ones are padded with empty voxels
//   colour  an entry per SOLID voxel, packed in entry_bits each; its index is the voxel's rank, the number of solid
//           voxels before it. The owner defines the meaning of entries: palette indices, or RGB in 24 bits
//
// Voxel (x, y, z) is the cube from (x, y, z) to (x + 1, y + 1, z + 1); right-handed, z up, like the world. Space
// outside the grid is empty.
//
// Bricks are stored in pages of 64, each with the entries of its own voxels: an edit repacks only the pages that it
// touches. Cost: 1.6 bits per voxel, and entry_bits per solid one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "scarp/field/voxel_box.h"

namespace scarp {

/// A dense voxel grid.
class VoxelGrid {
 public:
  static constexpr int kMaxSide = 2048;
  static constexpr int kBrick = 4;
  static constexpr int kMaxEntryBits = 24;

  /// An empty grid. Each side 1 to kMaxSide, entry_bits 1 to kMaxEntryBits; throws Error otherwise.
  explicit VoxelGrid(const ivec3& size, int entry_bits = 8);

  const ivec3& size() const { return size_; }
  VoxelBox box() const { return {ivec3(0), size_}; }
  int entry_bits() const { return entry_bits_; }
  std::int64_t solid_count() const { return solid_count_; }
  /// Smallest box around all solid voxels; empty if there are none.
  const VoxelBox& bounds() const { return bounds_; }
  /// Memory use in bytes.
  std::size_t bytes() const;

  /// Bricks per axis.
  const ivec3& bricks() const { return bricks_; }
  std::size_t brick_index(const ivec3& brick) const {
    return static_cast<std::size_t>(brick.x) +
           static_cast<std::size_t>(bricks_.x) *
               (static_cast<std::size_t>(brick.y) +
                static_cast<std::size_t>(bricks_.y) * static_cast<std::size_t>(brick.z));
  }
  std::uint64_t mask(const ivec3& brick) const { return masks_[brick_index(brick)]; }
  /// All bricks, by brick_index().
  std::span<const std::uint64_t> masks() const { return masks_; }
  /// Bit of a voxel in the mask of its brick.
  static int bit_of(const ivec3& voxel) { return (voxel.x & 3) | (voxel.y & 3) << 2 | (voxel.z & 3) << 4; }

  /// Returns whether a voxel is solid; it must be inside the grid.
  bool solid(const ivec3& voxel) const { return mask(voxel >> 2) >> bit_of(voxel) & 1; }
  /// Returns the entry of a solid voxel; 0 if drop_hidden_entries() dropped it.
  std::uint32_t entry(const ivec3& voxel) const;

  // Edits ignore positions outside the grid. They return a box around all voxels that may have changed, for updates of
  // accelerators and scenes. They throw Error if an entry does not fit in entry_bits(); all except edit() then change
  // nothing.

  VoxelBox set(const ivec3& voxel, std::uint32_t entry);
  VoxelBox clear(const ivec3& voxel);
  VoxelBox fill(const VoxelBox& box, std::uint32_t entry);
  VoxelBox clear(const VoxelBox& box);
  /// Fills voxels whose centres are within `radius` of `centre`, both in voxels.
  VoxelBox fill_sphere(const dvec3& centre, double radius, std::uint32_t entry);
  VoxelBox clear_sphere(const dvec3& centre, double radius);
  /// Changes the entries of solid voxels; empty ones stay empty.
  VoxelBox paint(const VoxelBox& box, std::uint32_t entry);
  VoxelBox paint_sphere(const dvec3& centre, double radius, std::uint32_t entry);

  /// New state of a voxel: its entry, or nullopt for empty. `before` is the old state.
  using Voxel = std::optional<std::uint32_t>;
  /// A voxel and its new state.
  struct Placed {
    ivec3 voxel;
    Voxel value;
  };
  /// Sets many voxels, in any order. If a position occurs more than once, the last one counts.
  VoxelBox set(std::span<const Placed> voxels);
  using Change = std::function<Voxel(const ivec3& voxel, const Voxel& before)>;
  /// Calls `change` once for each voxel of the box, in no particular order. If it throws, or returns an entry that does
  /// not fit, only some of the voxels visited so far are changed; counts and bounds stay consistent.
  VoxelBox edit(const VoxelBox& box, const Change& change);

  // Boolean operations with a grid of the same size and entry_bits. They throw Error if these differ.

  /// Union: adds the solid voxels of `other`. Voxels that are solid in both keep their entries in this grid.
  VoxelBox unite(const VoxelGrid& other);
  /// Intersection: clears voxels that are empty in `other`.
  VoxelBox intersect(const VoxelGrid& other);
  /// Difference: clears voxels that are solid in `other`.
  VoxelBox subtract(const VoxelGrid& other);

  /// Drops the entries of voxels that are invisible from outside: those whose six neighbours are all solid. Lossy: if a
  /// later edit exposes such a voxel, its entry is 0.
  void drop_hidden_entries();

 private:
  static constexpr int kPageBricks = 64, kRankBricks = 4;
  static constexpr int kRanks = kPageBricks / kRankBricks;

  // Entries of the voxels of 64 bricks, in the order of bricks and bits.
  struct Page {
    std::vector<std::uint64_t> words;               // entry_bits each, from the lowest bit on
    std::array<std::uint16_t, kRanks> rank_from{};  // entries before each group of kRankBricks bricks
  };
  struct PageVoxels;
  class Editing;
  using MaskOp = std::uint64_t (*)(std::uint64_t, std::uint64_t);

  std::span<const std::uint64_t> entry_masks() const { return coloured_.empty() ? masks_ : coloured_; }
  PageVoxels unpack(std::size_t page) const;
  void pack(std::size_t page, const PageVoxels& voxels);
  VoxelBox combine(const VoxelGrid& other, MaskOp op);
  void require_entry(std::uint32_t entry) const;
  VoxelBox scan_bounds() const;

  ivec3 size_, bricks_;
  int entry_bits_;
  std::vector<std::uint64_t> masks_;
  std::vector<std::uint64_t> coloured_;  // voxels with an entry; empty: all solid ones
  std::vector<Page> pages_;
  std::int64_t solid_count_ = 0;
  VoxelBox bounds_;
};

}  // namespace scarp
