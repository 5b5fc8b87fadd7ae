// SPDX-License-Identifier: MIT
// Writes OpenEXR images with any channels. Requires a build with OpenEXR (SCARP_OPENEXR).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "scarp/base/replace_file.h"

namespace scarp {

/// Storage of a channel: half keeps 11 significant bits and becomes infinite above 65504.
enum class ExrStorage { half, full };

/// One number per pixel, in caller-owned memory.
struct ExrChannel {
  std::string name;  ///< "R", "Z", "N.X", ...; not empty
  /// First pixel. Floats are stored as half or float, uint32 always as uint32.
  std::variant<const float*, const std::uint32_t*> data;
  int stride = 1;  ///< distance between pixels in numbers, >= 1
  ExrStorage storage = ExrStorage::full;
};

/// A 4 x 4 matrix in the file's header, for row vectors ([p 1] * matrix), row-major. OpenEXR's standard names are
/// worldToCamera and worldToNDC.
struct ExrMatrix {
  std::string name;
  std::array<float, 16> elements;
};

/// An image: rows from the top, no padding.
struct ExrView {
  int width = 0;                       ///< >= 1
  int height = 0;                      ///< >= 1
  std::vector<ExrChannel> channels{};  ///< at least one; names are unique
  std::vector<ExrMatrix> matrices{};
};

/// Writes scan lines with lossless ZIP compression to the temporary file of `file`, and commits it. `path` is only used
/// in messages. Throws Error if writing fails (disk full); then no file remains once `file` is destroyed.
void write_exr(ReplaceFile& file, const std::string& path, const ExrView& picture);

/// Writes to `path` as above.
void write_exr(const std::string& path, const ExrView& picture);

}  // namespace scarp
