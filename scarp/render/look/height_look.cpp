// SPDX-License-Identifier: MIT
#include "scarp/render/look/height_look.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scarp {

std::uint8_t grey_of_height(double height, double low, double high) {
  const double relief = high - low, share = relief > 0 ? std::clamp((height - low) / relief, 0.0, 1.0) : 1.0;
  return static_cast<std::uint8_t>(std::lround(1 + 254 * share));
}

Picture picture_of_heights(const PictureSettings& settings, std::span<const double> heights,
                           const std::optional<ReliefRange>& range) {
  Picture picture{Image(settings.width, settings.height)};
  ReliefRange grey =
      range.value_or(ReliefRange{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
  if (!range) {
    for (const double h : heights) {
      if (!std::isnan(h)) grey = {std::min(grey.low, h), std::max(grey.high, h)};
    }
    if (!(grey.low <= grey.high)) return picture;
    picture.heights = grey;
  }
  const auto width = static_cast<std::size_t>(settings.width);
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (std::isnan(heights[i])) continue;
    std::fill_n(picture.image.pixel(static_cast<int>(i % width), static_cast<int>(i / width)), 3,
                grey_of_height(heights[i], grey.low, grey.high));
  }
  return picture;
}

}  // namespace scarp
