// SPDX-License-Identifier: MIT
// Maximum and minimum mipmap of a height field: for every block of 2^level x 2^level cells, an upper and a lower bound
// of the surface in it, and a tilted plane above it (block_planes.h). Also keeps the steepest edges (relief_map.h).
//
//   level 0: the cells themselves, the extremes of their FOUR corner samples (both surfaces stay between them). Not
//            stored: a cell test needs the samples anyway, and all other levels take a quarter of the memory
//   level l: (n + 1) / 2 entries per side for n at level l-1, so odd sizes keep their last row and column; in a
//            wrapped field no block straddles the seam
//   top:     one entry; level 1 at least
//
// Entries are 16-bit codes, rounded outwards: height = base + step * code. For 16-bit samples codes equal the samples,
// without rounding. Maxima ignore holes; a block with a hole has no minimum (kNoMinimum).
//
// Source: A. Tevs, I. Ihrke, H.-P. Seidel, "Maximum mipmaps for fast, accurate, and scalable dynamic height field
// rendering", I3D 2008 (with maxima of cells instead of samples: maxima of samples do not bound the surface between
// them). Cost: 2 bytes per cell; built in two passes over the samples and two over each level.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "scarp/accel/height_code.h"
#include "scarp/accel/pyramid_levels.h"
#include "scarp/field/height_field.h"

namespace scarp {

class BlockPlanes;  // block_planes.h
class ReliefMap;    // relief_map.h
struct Blocks;

/// A maximum and minimum pyramid. Copies are cheap: they share the levels and see one another's updates. A pyramid does
/// not refer to the field it was built from. Only update() changes a pyramid, and must not run concurrently with
/// queries.
class MaxPyramid {
 public:
  /// Code of a block without a minimum: the block contains a hole, or the lowest code.
  static constexpr std::uint16_t kNoMinimum = 0;

  /// Builds all levels, on all threads. A field without cells has no levels. `reserve` widens the code range of float
  /// samples, and that of the planes of 16-bit samples, for later edits.
  explicit MaxPyramid(const HeightField& field, const std::optional<SampleRange>& reserve = std::nullopt);

  /// Recomputes the entries over `changed` after an edit of the same field, so that the extremes equal a rebuild with
  /// the same range. Rebuilds everything if float samples leave the range, and all planes if 16-bit samples leave
  /// theirs.
  void update(const HeightField& field, const CellBox& changed);

  /// Coarsest level; levels are 1 .. top_level(). 0 if the field has no cells.
  int top_level() const { return static_cast<int>(levels_.size()); }
  /// Blocks of all levels.
  std::size_t entries() const { return entries_; }
  std::size_t bytes() const;

  using Level = PyramidLevel;
  /// Levels 1, 2, ...; entries in rows from north to south, no padding. Three extra entries are allocated after the
  /// last: vector code reads up to four entries at a time.
  const std::vector<Level>& levels() const { return levels_; }
  const HeightCode& code() const { return shared_->code; }
  /// Maxima in the lower halves, planes in the upper.
  const std::uint32_t* blocks() const { return shared_->blocks.get(); }
  std::uint16_t maximum_code(std::ptrdiff_t entry) const { return static_cast<std::uint16_t>(blocks()[entry]); }
  const std::uint16_t* minima() const { return shared_->minima.get(); }
  const BlockPlanes& planes() const { return *planes_; }
  const ReliefMap& relief() const { return *relief_; }

  /// Bounds of one block in sample units, level 1 .. top_level(): the minimum is -infinity if there is none; the
  /// maximum of a block of holes is the height of code 0.
  double maximum(int level, int col, int row) const;
  double minimum(int level, int col, int row) const;

  /// Upper bound of the height difference within any cell, in code steps; up to 65535 with holes. After edits it may
  /// exceed the bound that a rebuild would give.
  int cell_relief() const { return shared_->cell_relief; }
  /// HeightField::edits() at the last update; if the field has more, queries may miss hits.
  std::uint64_t edits() const { return shared_->edits; }

 private:
  // State shared by copies.
  struct Shared {
    HeightCode code;
    SampleRange range;  // range of the codes
    int cell_relief = 0;
    std::uint64_t edits = 0;
    std::unique_ptr<std::uint32_t[]> blocks;
    std::unique_ptr<std::uint16_t[]> minima;
  };

  struct State;

  static constexpr std::size_t kSpareEntries = 3;

  void set_range(const HeightField& field, const std::optional<SampleRange>& reserve);
  void build(const HeightField& field, const CellBox& changed);
  Blocks all_blocks() const;

  std::vector<Level> levels_;
  std::size_t entries_ = 0;
  std::shared_ptr<Shared> shared_;
  // In the shared state.
  BlockPlanes* planes_;
  ReliefMap* relief_;
};

}  // namespace scarp
