// SPDX-License-Identifier: MIT
// Private to scarp/analysis: the heights of a field as floats within a margin of NaN, for code that loads vectors: of
// the whole field, or of a strip of it (horizon_strip.h).
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>

#include "scarp/analysis/horizon_strip.h"
#include "scarp/analysis/horizon_tiles.h"
#include "scarp/base/large_vector.h"
#include "scarp/field/height_field.h"

namespace scarp {

/// Properties of heights in memory that tables of crossings depend on.
struct HorizonLayout {
  int cols, rows, sign;
  std::ptrdiff_t pitch;        ///< samples from a row to the next
  std::ptrdiff_t whole_pitch;  ///< that of the whole field
};

/// The largest of |height|.
double tallest_of(const HeightField& field);

class HorizonHeights {
 public:
  /// Heights are rounded to float. `sign`: 1, or -1 for the ground upside down. `transposed`: columns here are rows of
  /// the field.
  HorizonHeights(const HeightField& field, int sign, bool transposed = false);
  /// A strip; everything around it is NaN or, beyond the margin of the strip, not in memory. `offset`: that of the
  /// strip's lines. `transposed`: `shape` is in columns and rows here, which are rows and columns of `tiles`.
  /// `memory`: that of an earlier strip, whose pages need not be found again.
  HorizonHeights(const HorizonTiles& tiles, const StripShape& shape, double offset, bool transposed = false,
                 LargeVector<float> memory = {});
  /// Its memory; nothing else may be called.
  LargeVector<float> release() { return std::move(values_); }

  static HorizonLayout layout_of(const HorizonTiles& tiles, const StripShape& shape, bool transposed = false);
  HorizonLayout layout() const { return {cols_, rows_, sign_, pitch_, whole_pitch_}; }

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
  /// Where node (0, 0) is, or would be, among them.
  std::ptrdiff_t origin() const { return origin_; }

  /// Samples on each side. Groups of nodes at a border look up to 16 columns and 2 rows past it; windows of level 0 of
  /// HorizonGround begin up to 24 samples before it, and lines of HorizonSweep 25.
  static constexpr int kMargin = 32;

 private:
  std::size_t place(int col, int row) const { return static_cast<std::size_t>(row * pitch_ + col + origin_); }

  int cols_, rows_, sign_;
  double tallest_;
  std::ptrdiff_t pitch_, whole_pitch_, origin_;
  LargeVector<float> values_;
};

}  // namespace scarp
