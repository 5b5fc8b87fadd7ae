// SPDX-License-Identifier: MIT
// A dense grid of voxels: which are solid, and the colour entry of each.
//
//   shape   one bit per voxel, in bricks of 4 x 4 x 4: a 64-bit mask, bit x + 4 y + 16 z
//   bricks  x fastest, then y, then z; the last ones of a size that is no multiple of 4 are padded with empty voxels
//   colour  an entry per SOLID voxel, packed in entry_bits each; its place is its rank, the number of solid voxels
//           before it. Entries are what the owner makes of them: indices into a palette, or RGB in 24 bits
//
// Voxel (x, y, z) is the cube from (x, y, z) to (x + 1, y + 1, z + 1); right-handed, z up, as the world is. Outside of
// the grid all is empty.
//
// Bricks are stored in pages of 64, each with the entries of its own voxels: an edit packs the pages that it touches
// again and no others. Cost: 1.6 bits per voxel, and entry_bits per solid one.
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

class VoxelGrid {
 public:
  static constexpr int kMaxSide = 2048;
  static constexpr int kBrick = 4;
  static constexpr int kMaxEntryBits = 24;

  /// All empty. Each side 1 to kMaxSide, entry_bits 1 to kMaxEntryBits. Throws Error otherwise.
  explicit VoxelGrid(const ivec3& size, int entry_bits = 8);

  const ivec3& size() const { return size_; }
  VoxelBox box() const { return {ivec3(0), size_}; }
  int entry_bits() const { return entry_bits_; }
  std::int64_t solid_count() const { return solid_count_; }
  /// The least box around all solid voxels; empty when there is none.
  const VoxelBox& bounds() const { return bounds_; }
  /// Memory that it takes, in bytes.
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
  /// The bit of a voxel in the mask of its brick.
  static int bit_of(const ivec3& voxel) { return (voxel.x & 3) | (voxel.y & 3) << 2 | (voxel.z & 3) << 4; }

  /// Whether a voxel of the grid is solid; the voxel must be inside.
  bool solid(const ivec3& voxel) const { return mask(voxel >> 2) >> bit_of(voxel) & 1; }
  /// The entry of a solid voxel; 0 where drop_hidden_entries() has dropped it.
  std::uint32_t entry(const ivec3& voxel) const;

  // Edits. Parts outside of the grid are left out; what they return is a box around all voxels that may have changed,
  // which accelerators and scenes need to be told. Entries must fit into entry_bits(); Error otherwise,
  // and nothing is changed (but by edit()).

  VoxelBox set(const ivec3& voxel, std::uint32_t entry);
  VoxelBox clear(const ivec3& voxel);
  VoxelBox fill(const VoxelBox& box, std::uint32_t entry);
  VoxelBox clear(const VoxelBox& box);
  /// Voxels whose centres are no farther than `radius` from `centre`, both in voxels.
  VoxelBox fill_sphere(const dvec3& centre, double radius, std::uint32_t entry);
  VoxelBox clear_sphere(const dvec3& centre, double radius);
  /// Gives solid voxels another entry; empty ones stay so.
  VoxelBox paint(const VoxelBox& box, std::uint32_t entry);
  VoxelBox paint_sphere(const dvec3& centre, double radius, std::uint32_t entry);

  /// What a voxel is to be: its entry, or nothing for empty. `before` is what it was.
  using Voxel = std::optional<std::uint32_t>;
  struct Placed {
    ivec3 voxel;
    Voxel value;
  };
  /// Many voxels, wherever they are; of several in one place the last one counts.
  VoxelBox set(std::span<const Placed> voxels);
  using Change = std::function<Voxel(const ivec3& voxel, const Voxel& before)>;
  /// Asks `change` about each voxel of the box, once, in no particular order. Where it throws, or its entry does not
  /// fit, some of the voxels that it was asked about are changed and others are not; counts and bounds are true to
  /// those that there are then.
  VoxelBox edit(const VoxelBox& box, const Change& change);

  // Booleans with another grid of the same size and entry_bits, on the masks; Error when they differ.

  /// Solid where one of them is. Its own entries stay.
  VoxelBox unite(const VoxelGrid& other);
  /// Solid where both are.
  VoxelBox intersect(const VoxelGrid& other);
  /// Solid where the other is not.
  VoxelBox subtract(const VoxelGrid& other);

  /// Keeps the entries only of voxels with an empty neighbour behind one of their six faces: those that can be seen
  /// from outside. Inside it is lossy: what a later edit lays bare has the entry 0.
  void drop_hidden_entries();

 private:
  static constexpr int kPageBricks = 64, kRankBricks = 4;
  static constexpr int kRanks = kPageBricks / kRankBricks;

  // The entries of the voxels of 64 bricks, in the order of the bricks and of their bits.
  struct Page {
    std::vector<std::uint64_t> words;               // entries, entry_bits each, from the lowest bit on
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
  std::vector<std::uint64_t> coloured_;  // which voxels have an entry; empty: all solid ones
  std::vector<Page> pages_;
  std::int64_t solid_count_ = 0;
  VoxelBox bounds_;
};

}  // namespace scarp
