// SPDX-License-Identifier: MIT
// The shadow that something beside the ground casts in the sun, as a map of heights: how it is made and how right it is
// stands in mesh_view.glsl.h.
#pragma once

#include <vector>

#include "scarp/base/vec.h"

namespace scarp {

/// The frame of a map, in the world.
struct SunMapFrame {
  dvec3 low{0.0};                                       ///< metres
  dvec3 across{1, 0, 0}, up{0, 1, 0}, to_sun{0, 0, 1};  ///< unit vectors
  double texel = 1;                                     ///< metres
  int side = 0;                                         ///< texels
  double range = 1;                                     ///< metres
  double reach = 0.5;                                   ///< texels
  double rounding = 0;                                  ///< of a height, as a share of range
};

class SunShadow {
 public:
  /// `heights`: side x side shares of the range, row by row; 0 where there is nothing.
  SunShadow(const SunMapFrame& frame, std::vector<float> heights);

  /// Whether the sun is hidden from a point of the ground.
  bool hides(const dvec3& position) const;

  const SunMapFrame& frame() const { return frame_; }
  const std::vector<float>& heights() const { return heights_; }

 private:
  SunMapFrame frame_;
  std::vector<float> heights_;
};

}  // namespace scarp
