// SPDX-License-Identifier: MIT
// PNG pictures, written whole or not at all.
#pragma once

#include <cstdint>
#include <string>

#include "scarp/base/replace_file.h"

namespace scarp {

/// Pixels of the caller's: rows from the top, 3 bytes (red, green, blue; sRGB) a pixel, no padding.
struct RgbView {
  const std::uint8_t* data = nullptr;
  int width = 0;   ///< >= 1
  int height = 0;  ///< >= 1
};

/// Writes an 8-bit RGB PNG into the place that `file` has reserved, and commits it. `path` is for messages only. Throws
/// Error when it cannot be written (disk full); then nothing is left once `file` is gone.
void write_png(ReplaceFile& file, const std::string& path, const RgbView& picture);

/// The same for a picture that was made already.
void write_png(const std::string& path, const RgbView& picture);

}  // namespace scarp
