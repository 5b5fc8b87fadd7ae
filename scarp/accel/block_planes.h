// SPDX-License-Identifier: MIT
// Tilted planes above the blocks of a pyramid: a tighter bound than their maxima wherever the ground slopes.
//
//        maximum ---------+      code     height of the plane in the middle of the block, 16 bits
//               plane  _-'       slopes   of the columns and rows, 8 bits each, in steps of unit() codes per cell
//                 _-' _^         entry    code | slope_x << 16 | slope_y << 24: one load, as for a maximum
//              -'__--'
//              ground            height at (x, y) cells from the middle: code + unit() (slope_x x + slope_y y)
//
// A plane above the four corners of a cell is above both of its surfaces. Level 1 takes the slopes between its corner
// samples; coarser levels take the mean slope of their four children and are above the children's planes. A block whose
// plane would be higher in the middle than its maximum is left flat. The slopes' range is that of
// the steepest cells, but at most eight times the mean.
//
// Source: own; bounding slabs with a direction are common for meshes (T. Kay, J. Kajiya, "Ray tracing complex scenes",
// SIGGRAPH 1986). Cost: 4/3 bytes per cell. Fields with holes have no planes, nor have
// those with more blocks than kMostEntries, which vectors do not traverse.
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

/// Maxima and minima of the same blocks, with their code.
struct BlockExtremes {
  const std::uint16_t* maxima;
  const std::uint16_t* minima;
  HeightCode code;
};

class BlockPlanes {
 public:
  static constexpr std::size_t kMostEntries = std::size_t{1} << 30;

  /// Planes of the blocks of all levels, on all threads. Codes cover the field's samples, and `reserve`.
  void build(const HeightField& field, const std::vector<PyramidLevel>& levels, const BlockExtremes& extremes,
             const std::optional<SampleRange>& reserve);
  /// Recomputes the planes over `changed` after an edit, or all if samples are higher than codes reach.
  void update(const HeightField& field, const std::vector<PyramidLevel>& levels, const BlockExtremes& extremes,
              const CellBox& changed);

  /// Entries of all levels in the order of the pyramid's; null for fields without planes.
  const std::uint32_t* entries() const { return entries_.get(); }
  const HeightCode& code() const { return code_; }
  float unit() const { return unit_; }
  /// The steepest slope that entries can have, in codes per cell along either axis.
  float steepest() const { return kMostSteps * unit_; }
  std::size_t bytes() const { return count_ * sizeof(std::uint32_t); }

  /// Height of a block's plane in sample units; x and y in cells from the middle of the full block, east and south.
  double height(std::ptrdiff_t entry, double x, double y) const;

 private:
  static constexpr int kMostSteps = 127;

  void set_scale(const HeightField& field, const PyramidLevel& first, const BlockExtremes& extremes,
                 const std::optional<SampleRange>& reserve);
  void fit(const HeightField& field, const std::vector<PyramidLevel>& levels, const BlockExtremes& extremes,
           const CellBox& changed);

  HeightCode code_;
  double highest_ = 0;  // that codes reach, in sample units
  float unit_ = 1;
  std::size_t count_ = 0;
  std::unique_ptr<std::uint32_t[]> entries_;
};

}  // namespace scarp
