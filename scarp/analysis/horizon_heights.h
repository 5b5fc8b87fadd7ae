// SPDX-License-Identifier: MIT
// Private to scarp/analysis: the heights of a field as floats within a margin of NaN, for code that loads vectors.
#pragma once

#include <cmath>
#include <cstddef>

#include "scarp/base/large_vector.h"
#include "scarp/field/height_field.h"

namespace scarp {

class HorizonHeights {
 public:
  /// Heights are rounded to float. `sign`: 1, or -1 for the ground upside down. `transposed`: columns here are rows of
  /// the field.
  HorizonHeights(const HeightField& field, int sign, bool transposed = false);

  int cols() const { return cols_; }
  int rows() const { return rows_; }
  int sign() const { return sign_; }
  /// The largest of |height|.
  double tallest() const { return tallest_; }

  /// Height of a node in metres; NaN on a hole and within the margin.
  const float* height(int col, int row) const { return &values_[place(col, row)]; }
  /// Samples from a row to the next.
  std::ptrdiff_t pitch() const { return pitch_; }
  /// Rows of `pitch` samples, the margin included.
  const LargeVector<float>& values() const { return values_; }

  /// Samples on each side. Groups of nodes at a border look up to 16 columns and 2 rows past it; windows of level 0 of
  /// HorizonGround begin up to 24 samples before it, and lines of HorizonSweep 25.
  static constexpr int kMargin = 32;

 private:
  std::size_t place(int col, int row) const {
    return static_cast<std::size_t>((row + kMargin) * pitch_ + kMargin + col);
  }

  int cols_, rows_, sign_;
  double tallest_;
  std::ptrdiff_t pitch_;
  LargeVector<float> values_;
};

}  // namespace scarp
