// SPDX-License-Identifier: MIT
// The look `height`: grey, linear in height from the lowest (1) to the highest (255) point; misses are black (0). The
// range is that of a terrain, so that its pictures can be compared, else that of the picture.
//
// With ComancheSettings::heights it shows what the rays of the look `comanche` hit.
#pragma once

#include <cstdint>
#include <span>

#include "scarp/render/frame/picture.h"

namespace scarp {

/// 1 at `low` to 255 at `high`, clamped beyond.
std::uint8_t grey_of_height(double height, double low, double high);

/// `heights`: width * height of them, metres, rows from the top; NaN: a miss. Without a range, it is that of `heights`,
/// which the picture then reports.
Picture picture_of_heights(const PictureSettings& settings, std::span<const double> heights,
                           const std::optional<ReliefRange>& range = {});

}  // namespace scarp
