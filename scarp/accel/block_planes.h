// SPDX-License-Identifier: MIT
// Tilted planes above the blocks of a pyramid: a tighter bound than the maxima wherever the ground slopes.
//
//        maximum ---------+      maximum  of the block, 16 bits
//               plane  _-'       slopes   of the columns and rows, 5 bits each, in steps of unit() codes per cell
//                 _-' _^         depth    of the plane in the middle of the block below the maximum, 6 bits, in steps
//              -'__--'                    of half a slope's step over half the block
//              ground            block    maximum | slope_x << 16 | slope_y << 21 | depth << 26: one load
//
// A plane above a cell's four corners is above the cell's surface, bilinear or triangles. Level 1 takes the slopes
// between the corner samples of the block; coarser levels take the mean slope of their four children and are above the
// children's planes. A block stays flat if its plane would be less than one depth step below its maximum. Slopes beyond
// the range are clamped, which makes the plane higher.
//
// Source: own; bounding slabs with a direction are common for meshes (T. Kay, J. Kajiya, "Ray tracing complex scenes",
// SIGGRAPH 1986). Cost: 2/3 bytes per cell. Fields with holes have no planes, nor do fields with more than kMostEntries
// blocks, which vector code does not traverse.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "scarp/accel/height_code.h"
#include "scarp/accel/pyramid_levels.h"
#include "scarp/field/height_field.h"

namespace scarp {

/// The blocks that planes are fitted to; their maxima and minima are already computed.
struct Blocks {
  const std::vector<PyramidLevel>& levels;
  std::uint32_t* maxima;  ///< input maxima; planes are added
  const std::uint16_t* minima;
  HeightCode code;  ///< of both
};

class BlockPlanes {
 public:
  static constexpr std::size_t kMostEntries = std::size_t{1} << 30;
  static constexpr int kSlopeBits = 5, kDepthBits = 6;
  /// Depth step, in units of a slope step times half the side of the block.
  static constexpr float kDepthUnits = 0.5f;

  /// Fits planes to the blocks of all levels, on all threads. For 16-bit samples, codes cover the field's samples and
  /// `reserve`, with room for edits; float samples use the code of the maxima.
  void build(const HeightField& field, const Blocks& blocks, const std::optional<SampleRange>& reserve);
  /// Refits planes to the blocks over `changed` after an edit, or to all blocks if 16-bit samples leave the codes'
  /// range or the last hole is gone. Fields with holes have none.
  void update(const HeightField& field, const Blocks& blocks, const CellBox& changed);

  bool exist() const { return exist_; }
  /// Plane and ray heights are compared in these codes; the code of a maximum is maximum * scale() + shift().
  const HeightCode& code() const { return code_; }
  float scale() const { return scale_; }
  float shift() const { return shift_; }
  float unit() const { return unit_; }
  /// The steepest slope that blocks can have, in codes per cell along either axis.
  float steepest() const { return kMostSteps * unit_; }

  /// Returns the height of a block's plane in sample units; x and y are the offsets in cells, east and south, from the
  /// centre of the full block.
  double height(std::uint32_t block, int level, double x, double y) const;

 private:
  static constexpr int kMostSteps = (1 << (kSlopeBits - 1)) - 1;

  void set_scale(const HeightField& field, const Blocks& blocks, const std::optional<SampleRange>& reserve);
  void fit(const HeightField& field, const Blocks& blocks, const CellBox& changed);

  bool exist_ = false;
  HeightCode code_;
  SampleRange range_;  // edits within it keep the code
  float scale_ = 1, shift_ = 0, unit_ = 1;
};

}  // namespace scarp
