// SPDX-License-Identifier: MIT
// A voxel grid: solidity, and a colour entry for each solid voxel.
//
//   shape   one bit per voxel, in bricks of 4 x 4 x 4: a 64-bit mask, bit x + 4 y + 16 z
//   bricks  x fastest, then y, then z; if a side is not a multiple of 4, the last ones are padded with empty voxels
//   colour  an entry per SOLID voxel, packed in entry_bits each; its index is the voxel's rank, the number of solid
//           voxels before it. The owner defines the meaning of entries: palette indices, or RGB in 24 bits
//
// Voxel (x, y, z) is the cube from (x, y, z) to (x + 1, y + 1, z + 1); right-handed, z up, like the world. Space
// outside the grid is empty.
//
// Bricks are stored in pages of 64, each with the entries of its voxels: an edit repacks only the pages that it
// touches. Pages without solid voxels are not stored; pages that are completely solid and have no entries share one.
// Cost: 1/1024 byte per voxel of the box (with more than 2^33 voxels: only where something is stored), 1.2 bits per
// voxel of a stored page, 2.2 if hidden voxels have no entry, and entry_bits per solid voxel that has one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "scarp/field/sparse_table.h"
#include "scarp/field/voxel_box.h"

namespace scarp {

/// A voxel grid.
class VoxelGrid {
 public:
  static constexpr int kMaxSide = 16384;
  /// Maximum side for code that builds or reads grids voxel by voxel.
  static constexpr int kMaxModelSide = 2048;
  static constexpr int kBrick = 4;
  static constexpr int kMaxEntryBits = 24;

  /// An empty grid. Throws Error unless each side is in 1..kMaxSide and entry_bits in 1..kMaxEntryBits.
  explicit VoxelGrid(const ivec3& size, int entry_bits = 8);

  /// Throws Error as the constructor does.
  static void require_size(const ivec3& size, int entry_bits);

  /// Fills a brick: sets the entries of its solid voxels, indexed by bit_of(), and returns its mask.
  using FillBrick = std::function<std::uint64_t(const ivec3& brick, std::span<std::uint32_t, 64> entries)>;
  /// Builds a grid brick by brick, on all threads; faster than edit(). `fill` is called once per brick, concurrently;
  /// voxels outside the grid are ignored. Throws Error as the constructor does, or if an entry does not fit.
  static VoxelGrid built(const ivec3& size, int entry_bits, const FillBrick& fill);

  /// State of a box of voxels. `full`: all are solid, and none has an entry.
  enum class Contents { empty, full, mixed };
  struct Brick {
    std::uint64_t solid = 0, coloured = 0;  ///< masks; coloured: the solid voxels that have an entry
  };
  /// Source of the voxels of a large grid. Its functions are called concurrently.
  struct Source {
    std::function<Contents(const VoxelBox& page)> contents;  ///< may extend beyond the grid
    std::function<Brick(const ivec3& brick, std::span<std::uint32_t, 64> entries)> fill;  ///< called for mixed pages
  };
  /// The same for large grids, page by page.
  static VoxelGrid built(const ivec3& size, int entry_bits, const Source& source);

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
  std::uint64_t mask(const ivec3& brick) const {
    const std::size_t index = brick_index(brick);
    return masks_[first_mask_[index / kPageBricks] + index % kPageBricks];
  }
  static constexpr int kPageBricks = 64;
  /// Masks of the stored pages, for vector code: the mask of brick_index() i is at first_masks()[i / kPageBricks] + i %
  /// kPageBricks. All empty pages share one.
  std::span<const std::uint64_t> masks() const { return masks_; }
  /// One index of masks() per page, followed by one extra readable entry.
  std::span<const std::uint32_t> first_masks() const { return first_mask_.values(); }
  /// first_masks() as a table, which is stored in chunks for grids with more than 2^33 voxels.
  const SparseTable<std::uint32_t>& page_table() const { return first_mask_; }
  /// Masks of the voxels with an entry, laid out as masks(); the same memory if no entry was dropped.
  std::span<const std::uint64_t> coloured_masks() const { return entry_masks(); }
  /// Stored entries of a page, for shaders: packed in entry_bits() each from the lowest bit up, with the number of
  /// entries before each group of 4 bricks. `stored` is the page's index in masks(), in pages.
  struct PackedEntries {
    std::span<const std::uint64_t> words;
    std::span<const std::uint16_t> rank_from;
  };
  PackedEntries packed_entries(std::size_t stored) const { return {pages_[stored].words, pages_[stored].rank_from}; }
  /// Calls body(brick, mask) for each brick with solid voxels, in the order of brick_index().
  template <class Body>
  void for_each_solid_brick(const Body& body) const {
    for (std::size_t page = first_mask_.next(0); page < page_count(); page = first_mask_.next(page + 1)) {
      if (is_empty(page)) continue;
      for (std::size_t i = 0; i < kPageBricks; ++i) {
        if (const std::uint64_t mask = masks_[first_mask_[page] + i]; mask != 0)
          body(brick_at(page * kPageBricks + i), mask);
      }
    }
  }
  /// Number of pages of a grid of this size.
  static std::int64_t pages_of(const ivec3& size);
  /// Size in bytes of a grid with `pages` non-empty pages and entries for `solid` voxels.
  static std::int64_t bytes_of(const ivec3& size, std::int64_t pages, std::int64_t solid, int entry_bits);
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
  static constexpr int kRankBricks = 4;
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
  bool is_empty(std::size_t page) const { return first_mask_[page] == 0 && empty_pages_ > 0; }
  bool is_full(std::size_t page) const { return full_ != 0 && first_mask_[page] == full_; }
  std::size_t page_count() const { return first_mask_.size(); }
  ivec3 brick_at(std::size_t index) const {
    const auto x = static_cast<std::size_t>(bricks_.x), y = static_cast<std::size_t>(bricks_.y);
    return {index % x, index / x % y, index / x / y};
  }
  VoxelBox page_box(std::size_t page) const;
  std::uint32_t add_page();
  Page packed_page(std::span<const std::uint64_t> coloured, std::span<const std::uint32_t> entries) const;
  std::size_t stored(std::size_t page);
  PageVoxels unpack(std::size_t page) const;
  void pack(std::size_t page, const PageVoxels& voxels);
  VoxelBox combine(const VoxelGrid& other, MaskOp op);
  void require_entry(std::uint32_t entry) const;
  VoxelBox scan_bounds() const;

  ivec3 size_, bricks_;
  int entry_bits_;
  SparseTable<std::uint32_t> first_mask_;
  std::uint32_t full_ = 0;               // the masks that full pages share; 0: none
  std::size_t empty_pages_;              // they share the first masks; the last one to be filled takes these
  std::vector<std::uint64_t> masks_;     // page by page
  std::vector<std::uint64_t> coloured_;  // voxels with an entry, likewise; empty: all solid ones
  std::vector<Page> pages_;              // as masks_
  std::int64_t solid_count_ = 0;
  VoxelBox bounds_;
};

}  // namespace scarp
