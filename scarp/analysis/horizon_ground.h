// SPDX-License-Identifier: MIT
// Private to scarp/analysis: the heights of a field with a margin, and maxima of windows over them, for horizon_scan.h.
//
//   level l   windows of 10 * 4^l x 10 * 4^l samples at every 4^l-th      bound segments of 8 * 4^l steps
//
// A segment of L steps of a line lies in L + 2 columns and rows, and the corner of its window is rounded down to one of
// those that exist: L + 2 + 4^l - 1 samples. From level 2 on, a window also covers all nodes of a group (15 columns and
// 1 row more), so that one number serves all of them: 8 * 4^l + 4^l + 16 <= 10 * 4^l.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "scarp/analysis/horizon_heights.h"
#include "scarp/base/progress.h"

namespace scarp {

/// Nodes of a group, examined together.
inline constexpr int kGroupCols = 16, kGroupRows = 2;

class HorizonGround {
 public:
  /// Maxima of a level; -inf over a window without ground. `corner` counts strides, and may be before the first sample.
  struct Maxima {
    LargeVector<float> values;
    std::ptrdiff_t pitch = 0;
    int first = 0;              // corner of the first value, in strides; not of strips
    std::ptrdiff_t origin = 0;  // place of corner (0, 0)
    const float* at(int corner_col, int corner_row) const {
      return &values[static_cast<std::size_t>(corner_row * pitch + corner_col + origin)];
    }
  };
  /// Levels 1, 2, ...
  using CoarseMaxima = std::vector<Maxima>;

  /// Steps of a segment of a level.
  static constexpr int steps_of(int level) { return 8 << (2 * level); }
  /// Distance of the corners of windows, in samples.
  static constexpr int stride_of(int level) { return 1 << (2 * level); }

  /// `sign`: as of HorizonHeights. `eye`: the highest eye above the ground that will look over it, in metres. Throws
  /// Interrupted.
  HorizonGround(const HeightField& field, int sign, float eye, const Progress& progress = {});

  /// The ground of a strip, with coarse levels of the whole field. `memory`: as of HorizonHeights.
  HorizonGround(HorizonHeights strip, float eye, std::shared_ptr<const CoarseMaxima> coarse, LargeVector<float> memory);
  std::pair<LargeVector<float>, LargeVector<float>> release() {
    return {heights_.release(), std::move(finest_.values)};
  }
  static CoarseMaxima coarse_maxima(const HorizonTiles& tiles, float eye, const Progress& progress);
  /// Bytes of these levels, while they are built.
  static double coarse_bytes(int cols, int rows);
  static int levels_of(int cols, int rows);

  const HorizonHeights& heights() const { return heights_; }
  int cols() const { return heights_.cols(); }
  int rows() const { return heights_.rows(); }
  int levels() const { return 1 + static_cast<int>(coarse_->size()); }
  const Maxima& maxima(int level) const {
    return level == 0 ? finest_ : (*coarse_)[static_cast<std::size_t>(level) - 1];
  }

 private:
  HorizonHeights heights_;
  Maxima finest_;
  std::shared_ptr<const CoarseMaxima> coarse_;
};

}  // namespace scarp
