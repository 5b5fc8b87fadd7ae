// SPDX-License-Identifier: MIT
// The look `height`: grey, linear in height from the lowest (1) to the highest (255) point; misses are black (0). The
// range is that of a terrain, so that its pictures can be compared, else that of the picture.
//
// With ComancheSettings::heights it shows what the rays of the look `comanche` hit.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "scarp/render/film/film.h"
#include "scarp/render/surface/ramp.h"

namespace scarp {

/// Returns the range of heights, in metres, that are not NaN; nullopt if all are.
std::optional<ReliefRange> range_of_heights(std::span<const double> heights);

/// 1 at `low` to 255 at `high`, clamped beyond.
std::uint8_t grey_of_height(double height, const ReliefRange& range);

/// `heights`: width * height of them, metres, rows from the top; NaN: a miss.
Image image_of_heights(ImageSize size, std::span<const double> heights, const ReliefRange& range);

}  // namespace scarp
