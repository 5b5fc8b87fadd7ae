// SPDX-License-Identifier: MIT
#include "scarp/render/light/sun_shadow.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace scarp {

SunShadow::SunShadow(const SunMapFrame& frame, std::vector<float> heights)
    : frame_(frame), heights_(std::move(heights)) {}

bool SunShadow::hides(const dvec3& position) const {
  const dvec3 from_low = position - frame_.low;
  const double i = std::floor(dot(from_low, frame_.across) / frame_.texel),
               j = std::floor(dot(from_low, frame_.up) / frame_.texel);
  if (!(i >= 0 && j >= 0 && i < frame_.side && j < frame_.side)) return false;
  // Below all of the mesh, 0 still means nothing.
  const double height = std::max(0.0, dot(from_low, frame_.to_sun) / frame_.range + frame_.rounding);
  const auto texel = static_cast<std::size_t>(j) * static_cast<std::size_t>(frame_.side) + static_cast<std::size_t>(i);
  return static_cast<double>(heights_[texel]) > height;
}

}  // namespace scarp
