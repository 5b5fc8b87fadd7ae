// SPDX-License-Identifier: MIT
// Private to scarp/analysis: the heights of a field with a margin, and maxima of windows over them, for horizon_scan.h.
//
//   level 0   window of 10 x 10 samples at every sample                     bounds segments of 8 steps
//   level 1   37 x 37 at every 4th                                          32
//   level 2   161 x 161 at every 16th                                       128
//   level l   2 * 4^l steps + quantisation of the corner + a group          8 * 4^l
//
// A segment of L steps of a line lies in L + 2 columns and rows. From level 2 on, a window also covers all nodes of a
// group (16 columns, 2 rows), so that one number serves all of them.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/field/height_field.h"

namespace scarp {

/// Nodes of a group, examined together.
inline constexpr int kGroupCols = 16, kGroupRows = 2;

class HorizonGround {
 public:
  /// Steps of a segment of the first level; each further level has four times as many.
  static constexpr int kFirstSteps = 8;
  static constexpr int steps_of(int level) { return kFirstSteps << (2 * level); }
  /// Distance of the corners of windows, in samples.
  static constexpr int stride_of(int level) { return 1 << (2 * level); }

  /// Heights are rounded to float. `sign`: 1, or -1 for the ground upside down. `eye`: the highest eye above the ground
  /// that will look over it, in metres. Throws Interrupted.
  HorizonGround(const HeightField& field, int sign, float eye, const Progress& progress = {});

  int cols() const { return cols_; }
  int rows() const { return rows_; }
  int levels() const { return static_cast<int>(levels_.size()); }

  /// Height of a node in metres; NaN on a hole and within the margin.
  const float* height(int col, int row) const { return &heights_[place(col, row)]; }
  std::ptrdiff_t pitch() const { return pitch_; }

  /// Maxima of a level; -inf over a window without ground. `corner` counts strides, and may be before the first.
  struct Maxima {
    std::vector<float> values;
    std::ptrdiff_t pitch = 0;
    int first = 0;  // corner of the first value, in strides
    const float* at(int corner_col, int corner_row) const {
      return &values[static_cast<std::size_t>((corner_row - first) * pitch + (corner_col - first))];
    }
  };
  const Maxima& maxima(int level) const { return levels_[static_cast<std::size_t>(level)]; }

 private:
  std::size_t place(int col, int row) const {
    return static_cast<std::size_t>((row + kMarginRows) * pitch_ + kMarginCols + col);
  }
  void build_first(const Progress& progress);
  void build_coarser(int level);

  // Nodes at the border look up to 16 columns and 2 rows past it, windows of level 0 up to 24 and 12.
  static constexpr int kMarginCols = 64, kMarginRows = 32;

  int cols_, rows_;
  std::ptrdiff_t pitch_;
  std::vector<float> heights_;
  std::vector<Maxima> levels_;
  std::vector<int> windows_;  // samples per side that the windows of a level cover
  float above_ = 0;           // that maxima are higher: horizon_scan.h says why
};

}  // namespace scarp
