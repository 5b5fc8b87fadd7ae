// SPDX-License-Identifier: MIT
#include "scarp/render/look/height_look.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scarp {

std::optional<ReliefRange> range_of_heights(std::span<const double> heights) {
  ReliefRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const double h : heights) {
    if (!std::isnan(h)) range = {std::min(range.low, h), std::max(range.high, h)};
  }
  return range.low <= range.high ? std::optional(range) : std::nullopt;
}

std::uint8_t grey_of_height(double height, const ReliefRange& range) {
  const double relief = range.high - range.low;
  const double share = relief > 0 ? std::clamp((height - range.low) / relief, 0.0, 1.0) : 1.0;
  return static_cast<std::uint8_t>(std::lround(1 + 254 * share));
}

Image image_of_heights(ImageSize size, std::span<const double> heights, const ReliefRange& range) {
  Image image(size.width, size.height);
  const auto width = static_cast<std::size_t>(size.width);
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (std::isnan(heights[i])) continue;
    std::fill_n(image.pixel(static_cast<int>(i % width), static_cast<int>(i / width)), 3,
                grey_of_height(heights[i], range));
  }
  return image;
}

}  // namespace scarp
