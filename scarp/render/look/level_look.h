// SPDX-License-Identifier: MIT
// The look `level`: a level of the maximum pyramid of a height field (accel/max_pyramid.h), shown on the ground. Each
// pixel shows the maximum of the node that contains the cell hit by its ray, in the grey levels of the look `height`:
// level 0 is the highest corner of each cell, level N the maximum of 2^N x 2^N cells. A map shows the level as an
// image.
#pragma once

#include "scarp/accel/max_pyramid.h"
#include "scarp/scene/scene.h"

namespace scarp {

class LevelMaxima {
 public:
  /// Refers to the scene. Throws Error if the scene is not a single height field, or its pyramid lacks the level.
  LevelMaxima(const Scene& scene, int level);

  /// Returns the maximum of the node that contains a cell, in metres; from level 1 on, it is rounded up to a code of
  /// the pyramid. The cell must exist and must not be a hole.
  double over(const Cell& cell) const;

 private:
  const HeightField& field_;
  int level_;
  MaxPyramid pyramid_;
};

}  // namespace scarp
