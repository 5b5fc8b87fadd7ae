// SPDX-License-Identifier: MIT
// An image that is repeated over the ground and modulates its brightness.
//
//   detail = 2 * (grey - mean grey)    -2 to 2; the mean is 0, so the ground keeps its brightness on average
//
// Coarser levels are area averages, each half the size of the finer one, down to a single texel. Detail smaller than a
// pixel fades to 0.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scarp/base/vec.h"

namespace scarp {

class DetailTexture {
 public:
  /// Maximum width and height in pixels.
  static constexpr int kMostSide = 8192;

  /// `rgba`: 4 bytes per pixel, sRGB, rows from the north. Grey is the luma of the stored values (Rec. ITU-R BT.709);
  /// the fourth byte is ignored. Throws Error if a side is not in 1..kMostSide or `rgba` has another size.
  DetailTexture(int width, int height, std::span<const std::uint8_t> rgba);

  int width() const { return width_; }
  int height() const { return height_; }
  /// Returns the detail at a position in metres of the ground, x east and y north. The image is `size` metres wide,
  /// with its south-west corner at (0, 0); a pixel is `footprint` metres wide.
  double at(const dvec2& position, double size, double footprint) const;
  /// Texels of all levels, the finest first, rows from the north.
  std::span<const float> texels() const { return texels_; }

 private:
  int width_, height_;
  std::vector<float> texels_;
};

}  // namespace scarp
