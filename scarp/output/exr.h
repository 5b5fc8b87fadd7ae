// SPDX-License-Identifier: MIT
// OpenEXR pictures of any channels, written whole or not at all. Needs a build with OpenEXR (SCARP_OPENEXR).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "scarp/base/replace_file.h"

namespace scarp {

/// How a channel is stored: half loses all but 11 binary digits, and is infinite above 65504.
enum class ExrStorage { half, full };

/// One number per pixel, of the caller's.
struct ExrChannel {
  std::string name;  ///< "R", "Z", "N.X", ...; not empty
  /// The first pixel; float is stored as half or float, uint32 always as it is.
  std::variant<const float*, const std::uint32_t*> data;
  int stride = 1;  ///< from pixel to pixel, in numbers; >= 1
  ExrStorage storage = ExrStorage::full;
};

/// A 4 x 4 matrix in the file's header, for row vectors: [p 1] times the matrix; element (row, column) at
/// 4 * row + column. OpenEXR's standard names are worldToCamera and worldToNDC.
struct ExrMatrix {
  std::string name;
  std::array<float, 16> elements;
};

/// Rows from the top, no padding.
struct ExrView {
  int width = 0;                       ///< >= 1
  int height = 0;                      ///< >= 1
  std::vector<ExrChannel> channels{};  ///< at least one, each name once
  std::vector<ExrMatrix> matrices{};
};

/// Writes scan lines with lossless ZIP compression into the place that `file` has reserved, and commits it. `path` is
/// for messages only. Throws Error when it cannot be written (disk full); then nothing is left once `file` is gone.
void write_exr(ReplaceFile& file, const std::string& path, const ExrView& picture);

/// The same for a picture that was made already.
void write_exr(const std::string& path, const ExrView& picture);

}  // namespace scarp
