// SPDX-License-Identifier: MIT
// The look `level`: a level of the maximum pyramid of a height field (accel/max_pyramid.h) as boxes. Each block of
// 2^N x 2^N cells is a box from below the ground up to its maximum, in the grey of that height; its sides are darker.
// Level 0 has a box per cell, up to its highest corner. A map shows the boxes from above: the level as an image.
//
//            +-------+
//     ray    |       |          a march skips a block if the ray stays above its box, and descends into it otherwise
//   ------>--|->     +-------+
//            |       |       |
//
// A block without any ground has no box.
#pragma once

#include <optional>
#include <vector>

#include "scarp/scene/scene.h"

namespace scarp {

class LevelBoxes {
 public:
  /// Refers to the scene. Throws Error if the scene is not a single height field, its pyramid lacks the level, or the
  /// field wraps: boxes need borders.
  LevelBoxes(const Scene& scene, int level);

  struct Hit {
    double height = 0;  ///< maximum of the block, in metres; from level 1 on, it is rounded up to a code of the pyramid
    float shade = 1;    ///< brightness of the side that was hit; 1: the top
  };
  /// Returns the first box that the ray enters; nullopt if there is none. A ray that starts in a box leaves it first.
  std::optional<Hit> hit(const Ray& ray) const;

 private:
  bool has_ground(int col, int row) const;
  double maximum_of(int col, int row) const;

  const HeightField& field_;
  int level_;
  int cols_ = 0, rows_ = 0;     // of blocks
  double base_, highest_ = 0;   // z of the lower ends of the boxes, and of the highest
  std::vector<double> maxima_;  // from level 1 on, in rows; NaN: no box
};

}  // namespace scarp
