// SPDX-License-Identifier: MIT
// The look `height` of scenes and functions, which have no heights of their own that all pictures could share: grey,
// linear in height from the lowest (1) to the highest (255) point that the picture shows; misses are black (0).
#pragma once

#include <cstdint>
#include <span>

#include "scarp/render/frame/picture.h"

namespace scarp {

/// 1 at `low` to 255 at `high`, those of what is beyond likewise.
std::uint8_t grey_of_height(double height, double low, double high);

/// `heights`: width * height of them, metres, rows from the top; NaN: a miss.
Picture picture_of_heights(const PictureSettings& settings, std::span<const double> heights);

}  // namespace scarp
