// SPDX-License-Identifier: MIT
// Reads and writes numbers, strings and dictionaries in .vox files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "scarp/source/voxel/vox_file.h"

namespace scarp {

/// Reads from the start of `bytes`; every call throws Error if they end too early.
class VoxBytes {
 public:
  explicit VoxBytes(std::string_view bytes) : rest_(bytes) {}

  std::size_t left() const { return rest_.size(); }
  std::string_view rest() const { return rest_; }
  std::string_view take(std::size_t count);
  std::int32_t number();
  /// Reads a count of items that take at least `least_bytes` each.
  std::size_t count(std::size_t least_bytes);
  std::string text();
  VoxAttributes attributes();

 private:
  std::string_view rest_;
};

/// Formats bytes of a file for a message: in quotes, at most 24, with dots for unprintable bytes.
std::string printable(std::string_view bytes);

/// Parses an integer attribute. Throws Error naming it as `what`.
int whole_number(std::string_view text, std::string_view what);

}  // namespace scarp
