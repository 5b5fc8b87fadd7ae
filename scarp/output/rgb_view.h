// SPDX-License-Identifier: MIT
// Pixels to write.
#pragma once

#include <cstdint>

namespace scarp {

/// Caller-owned pixels: rows from the top, 3 bytes (red, green, blue; sRGB) per pixel, no padding.
struct RgbView {
  const std::uint8_t* data = nullptr;
  int width = 0;   ///< >= 1
  int height = 0;  ///< >= 1
};

}  // namespace scarp
