// SPDX-License-Identifier: MIT
// The look `level`: a level of the maximum pyramid of a height field (accel/max_pyramid.h), painted on the ground. Each
// pixel shows the maximum of the node over the cell that its ray hits, grey as in the look `height`: level 0 the
// highest corner of each cell, level N the highest of 2^N x 2^N cells. In a map the level appears as an image of its
// nodes.
#pragma once

#include "scarp/accel/max_pyramid.h"
#include "scarp/scene/scene.h"

namespace scarp {

class LevelMaxima {
 public:
  /// Refers to the scene. Throws Error if that is not a single height field, or if its pyramid has no such level.
  LevelMaxima(const Scene& scene, int level);

  /// Returns the maximum of the node over a cell in metres, as the pyramid stores it: rounded up to one of its codes
  /// from level 1 on. The cell must exist and must not be a hole.
  double over(const Cell& cell) const;

 private:
  const HeightField& field_;
  int level_;
  MaxPyramid pyramid_;
};

}  // namespace scarp
