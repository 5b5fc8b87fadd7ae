// SPDX-License-Identifier: MIT
// The highest sample of every block of a field, so that sweeps skip blocks below the horizon.
#pragma once

#include <vector>

#include "scarp/field/height_field.h"

namespace scarp {

class BlockMaxima {
 public:
  static constexpr int kSide = 16;  ///< samples

  /// Scans the field once, on all threads. Blocks overlap: each has one sample more to every side, so that every edge
  /// between two samples lies in a block.
  explicit BlockMaxima(const HeightField& field);

  /// Returns the maximum of the samples kSide * col - 1 .. kSide * (col + 1), and likewise for rows, in metres;
  /// -infinity for holes alone.
  double maximum(int col, int row) const {
    return maxima_[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_) + static_cast<std::size_t>(col)];
  }

 private:
  int cols_;
  std::vector<double> maxima_;
};

}  // namespace scarp
