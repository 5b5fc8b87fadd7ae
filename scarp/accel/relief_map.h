// SPDX-License-Identifier: MIT
// Steepest edge between two neighbouring samples in each block of 8 x 8 cells, rounded up.
//
//   o--o--o--o     an edge: the side of a cell, of columns or of rows; its steepness is the height difference of its
//   |  |  |  |     ends. Along a grid axis the surface in a block rises by at most this much per cell, bilinear or
//   o--o--o--o     triangles.
//
// Used for adjacent rays from one origin: while one of them is above the ground, another one is too if it is higher by
// more than the ground can rise between them (march/height/max_mip_fan.h). Nodata samples count as the field's lowest
// sample.
//
// Source: own. Cost: 4 bytes per 64 cells, one pass over the samples.
#pragma once

#include <cstddef>
#include <vector>

#include "scarp/field/height_field.h"

namespace scarp {

class ReliefMap {
 public:
  /// Cells per side of a block, as a power of two.
  static constexpr int kLevel = 3;

  /// Computes all blocks, on all threads. A field without cells has none.
  void build(const HeightField& field);
  /// Recomputes the blocks over `changed` after an edit; these then equal a rebuild.
  void update(const HeightField& field, CellBox changed);

  int cols() const { return cols_; }
  int rows() const { return rows_; }
  std::size_t bytes() const { return blocks_.size() * sizeof(float); }
  /// Rows from north to south, no padding. In sample units per cell.
  const float* row(int r) const { return blocks_.data() + static_cast<std::ptrdiff_t>(r) * cols_; }
  /// Height that is substituted for nodata samples.
  float lowest() const { return lowest_; }

 private:
  int cols_ = 0, rows_ = 0;
  float lowest_ = 0;
  bool holes_ = false;
  std::vector<float> blocks_;
};

}  // namespace scarp
