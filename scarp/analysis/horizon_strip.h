// SPDX-License-Identifier: MIT
// Private to scarp/analysis: a strip of samples along parallel lines, in memory of the strip's size in which the
// samples around a node lie as in the memory of a whole field: `pitch` further with each row, 1 with each column.
//
//   along rows       .  .[o  o  o] .  .      the strip's samples (o) in one row after another. The pitch is little more
//                    .  .  .[o  o  o] .      than the width of the strip, so that the rows follow one another in
//                    .  .  .[o  o  o] .      memory; nodes outside of the strip have the addresses of others within it.
//
//   along columns    [o  o] .  .  .  .       the same where lines run along the columns: a row holds a short part of
//                     .  .[o  o] .  .        the strip, or all columns if the lines are nearly parallel to them.
//
// Code that asks for samples near the lines of the strip alone needs not know that it is one.
#pragma once

#include <cstddef>

namespace scarp {

class StripShape {
 public:
  /// The field has `cols` x `rows` samples. Lines advance by `drift` columns with each row, -1 to 1 (`along_columns`:
  /// rows with each column). The strip is `width` columns (rows) wide. Only rows (columns) [begin, end) of the
  /// field matter, and a margin around them.
  StripShape(int cols, int rows, bool along_columns, double drift, int width, int begin, int end);

  std::ptrdiff_t pitch() const { return pitch_; }

  // The functions below describe the strip whose first line crosses row 0 (`along_columns`: column 0) at `offset`.

  /// Rows with samples of the strip, which may be beyond the field.
  int row_begin(double offset) const;
  int row_end(double offset) const;
  /// Columns of the strip in one of its rows, which may be beyond the field.
  int col_begin(double offset, int row) const;
  int col_end(double offset, int row) const;
  /// Samples in memory, and the place of node (0, 0) among them.
  std::size_t samples(double offset) const;
  std::ptrdiff_t origin(double offset) const;
  /// No strip has more samples.
  double most_samples() const;

 private:
  // Rows or columns around those that matter, for vectors and windows at the border.
  static constexpr int kMargin = 48;

  int cols_, rows_;
  bool along_columns_, whole_rows_ = false;
  double drift_;
  int width_, begin_, end_;
  std::ptrdiff_t pitch_;
};

}  // namespace scarp
