// SPDX-License-Identifier: MIT
// The highest sample of every block of a field. Sweeps skip blocks below the horizon; lines of sight skip blocks below
// the line.
//
// MaxPyramid is not sufficient here: it ignores cells with a hole, but `crossings` counts their sides if the samples
// exist.
#pragma once

#include <vector>

#include "scarp/field/height_field.h"

namespace scarp {

/// Maxima of blocks of kSide and of kCoarse samples per side. Takes 8 bytes per 252 samples. Does not follow edits.
class BlockMaxima {
 public:
  static constexpr int kSide = 16, kCoarse = 128;  ///< samples

  /// Scans the field once, on all threads. Blocks overlap by one more sample on every side, so that every edge between
  /// two samples is in a block.
  explicit BlockMaxima(const HeightField& field);

  /// Returns the maximum of the samples kSide * col - 1 .. kSide * (col + 1), and likewise for rows, in metres;
  /// -infinity if all are holes.
  double maximum(int col, int row) const { return fine_.at(col, row); }

  /// Returns an upper bound in metres of the nodes [col, col_end] x [row, row_end], ends included and inside the field,
  /// from blocks of `side` samples: kSide or kCoarse.
  double highest(int side, int col, int row, int col_end, int row_end) const;

 private:
  struct Level {
    int cols = 0;
    std::vector<double> maxima{};

    double at(int col, int row) const {
      return maxima[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col)];
    }
  };

  Level fine_, coarse_;
};

}  // namespace scarp
