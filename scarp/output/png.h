// SPDX-License-Identifier: MIT
// Writes PNG images.
#pragma once

#include <cstdint>
#include <string>

#include "scarp/base/replace_file.h"

namespace scarp {

/// Caller-owned pixels: rows from the top, 3 bytes (red, green, blue; sRGB) per pixel, no padding.
struct RgbView {
  const std::uint8_t* data = nullptr;
  int width = 0;   ///< >= 1
  int height = 0;  ///< >= 1
};

/// Writes an 8-bit RGB PNG to the temporary file of `file`, and commits it. `path` is for messages only. Throws Error
/// if writing fails (disk full); then no file remains once `file` is destroyed.
void write_png(ReplaceFile& file, const std::string& path, const RgbView& picture);

/// Opens `path` and writes to it as above.
void write_png(const std::string& path, const RgbView& picture);

}  // namespace scarp
