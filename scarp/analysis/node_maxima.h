// SPDX-License-Identifier: MIT
// Highest node of any rectangle of a field, rounded up to blocks: lines of sight skip what is below them.
//
// MaxPyramid is not enough here: it ignores the cells of a hole, and the side between two of them counts in
// `crossings` if its samples exist.
#pragma once

#include <vector>

#include "scarp/field/height_field.h"

namespace scarp {

/// Maxima of blocks of kFine and kCoarse nodes per side. Takes 4 bytes for 255 nodes. Does not follow edits.
class NodeMaxima {
 public:
  static constexpr int kFine = 16, kCoarse = 128;

  /// Scans the field, on all threads.
  explicit NodeMaxima(const HeightField& field);

  /// Upper bound in metres of the nodes [col, col_end] x [row, row_end], ends included and inside the field; -infinity
  /// if all are holes. Reads blocks of `side`, kFine or kCoarse.
  double highest(int side, int col, int row, int col_end, int row_end) const;

 private:
  struct Level {
    int cols = 0;
    std::vector<float> highest;  // sample units, rounded up
  };
  const Level& level(int side) const { return side == kFine ? fine_ : coarse_; }

  HeightField field_;
  Level fine_, coarse_;
};

}  // namespace scarp
