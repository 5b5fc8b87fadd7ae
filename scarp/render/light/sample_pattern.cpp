// SPDX-License-Identifier: MIT
#include "scarp/render/light/sample_pattern.h"

#include <bit>

#include "scarp/render/light/sample_pattern.glsl.h"

namespace scarp {

dvec2 PixelPoints::operator[](std::uint32_t i) const {
  return glsl::scarp_pixel_point({x_, y_, seed_x_, seed_y_, seed_order_, index_bits_}, i);
}

SamplePattern::SamplePattern(std::uint32_t seed, std::uint32_t points_per_pixel)
    : seed_(seed), index_bits_(std::bit_width(points_per_pixel - 1)) {}

PixelPoints SamplePattern::pixel(int x, int y, std::uint32_t purpose) const {
  const glsl::ScarpPixelPoints at = glsl::scarp_pixel_points(seed_, index_bits_, static_cast<std::uint32_t>(x),
                                                             static_cast<std::uint32_t>(y), purpose);
  PixelPoints points;
  points.x_ = at.x;
  points.y_ = at.y;
  points.seed_x_ = at.seed_x;
  points.seed_y_ = at.seed_y;
  points.seed_order_ = at.seed_order;
  points.index_bits_ = at.index_bits;
  return points;
}

}  // namespace scarp
