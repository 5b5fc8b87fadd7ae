// SPDX-License-Identifier: MIT
// Writes JPEG images. Requires a build with GDAL (SCARP_GDAL).
#pragma once

#include <string>

#include "scarp/base/replace_file.h"
#include "scarp/output/rgb_view.h"

namespace scarp {

/// Writes a JPEG of quality 90 to the temporary file of `file`, and commits it. `path` is only used in messages. Throws
/// Error if a side is longer than 65500 pixels, the format's limit, or writing fails (disk full); then no file remains
/// once `file` is destroyed.
void write_jpeg(ReplaceFile& file, const std::string& path, const RgbView& picture);

}  // namespace scarp
