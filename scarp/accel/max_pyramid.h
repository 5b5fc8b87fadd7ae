// SPDX-License-Identifier: MIT
// Maximum and minimum mipmap of a height field: for every block of 2^level x 2^level cells, a height that no point of
// the surface in it exceeds, and one that no point is below.
//
//   level 0: the cells themselves, the extremes of FOUR corner samples each (both surfaces stay between them). Not
//   stored:
//            who looks at a cell needs its samples anyway, and a quarter of the memory holds all other levels
//   level l: (n + 1) / 2 entries per side for n at level l-1, so odd sizes keep their last row and column; in a field
//            that wraps round, no block straddles the seam
//   top:     one entry, on level 1 at least
//
// Entries are 16-bit codes, rounded outwards: height = base + step * code. For 16-bit samples codes are the samples and
// nothing is rounded. A hole is left out of the maxima; a block with a hole has no minimum (kNoMinimum).
//
// Source: A. Tevs, I. Ihrke, H.-P. Seidel, "Maximum mipmaps for fast, accurate, and scalable dynamic height field
// rendering", I3D 2008 (maxima of cells instead of samples: those of samples do not bound what lies between them).
// Cost: 4/3 bytes per cell; built in one pass over the samples and one over each level.
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

/// Cheap to copy: copies share the levels and see one another's updates. Built from a field, it does not refer to it
/// afterwards. Nothing but update() changes a pyramid; while it runs, no query may.
class MaxPyramid {
 public:
  /// The code of a block without a minimum: it has a hole, or is as low as codes go.
  static constexpr std::uint16_t kNoMinimum = 0;

  /// Builds all levels, on all threads. A field without cells has a pyramid without levels. `reserve` widens the range
  /// of the codes of float samples to what later edits will stay in; 16-bit samples never leave theirs.
  explicit MaxPyramid(const HeightField& field, const std::optional<SampleRange>& reserve = std::nullopt);

  /// After an edit of the same field: computes the entries over `changed` again and no others, so that the levels are
  /// those of a pyramid built anew with the same range. When float samples have left that range all is built anew.
  void update(const HeightField& field, const CellBox& changed);

  /// Levels are 1 .. top_level(); 0 when the field has no cells.
  int top_level() const { return static_cast<int>(levels_.size()); }
  std::size_t bytes() const { return 2 * entries_ * sizeof(std::uint16_t); }

  using Level = PyramidLevel;
  /// Levels 1, 2, ...; their entries lie in rows from north to south, no padding. Behind the last one there is room for
  /// another: vectors read two entries where they need one.
  const std::vector<Level>& levels() const { return levels_; }
  const HeightCode& code() const { return shared_->code; }
  const std::uint16_t* maxima() const { return shared_->maxima.get(); }
  const std::uint16_t* minima() const { return shared_->minima.get(); }

  /// Bounds of one block in sample units, level from 1 to top_level(): the minimum is -infinity when there is none, the
  /// maximum that of code 0 when the block is all holes.
  double maximum(int level, int col, int row) const;
  double minimum(int level, int col, int row) const;

  /// No two points of a cell differ by more, in steps of the code; where there are holes, up to 65535. After edits it
  /// may be more than a pyramid built anew would say.
  int cell_relief() const { return shared_->cell_relief; }

 private:
  // What copies share.
  struct Shared {
    HeightCode code;
    SampleRange range;  // what the codes can hold
    int cell_relief = 0;
    std::unique_ptr<std::uint16_t[]> maxima, minima;
  };

  void set_range(const HeightField& field, const std::optional<SampleRange>& reserve);
  void build(const HeightField& field, const CellBox& changed);

  std::vector<Level> levels_;
  std::size_t entries_ = 0;
  std::shared_ptr<Shared> shared_;
};

}  // namespace scarp
