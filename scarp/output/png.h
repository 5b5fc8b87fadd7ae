// SPDX-License-Identifier: MIT
// Writes PNG images.
#pragma once

#include <string>

#include "scarp/base/replace_file.h"
#include "scarp/output/rgb_view.h"

namespace scarp {

/// Writes an 8-bit RGB PNG to the temporary file of `file`, and commits it. `path` is only used in messages. Throws
/// Error if writing fails (disk full); then no file remains once `file` is destroyed.
void write_png(ReplaceFile& file, const std::string& path, const RgbView& picture);

/// Writes to `path` as above.
void write_png(const std::string& path, const RgbView& picture);

}  // namespace scarp
