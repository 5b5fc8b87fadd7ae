// SPDX-License-Identifier: MIT
// Numbers, texts and dictionaries in the bytes of a .vox file, in and out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "scarp/source/vox_file.h"

namespace scarp {

/// Reads from the beginning of some bytes; every call throws Error where they end too early.
class VoxBytes {
 public:
  explicit VoxBytes(std::string_view bytes) : rest_(bytes) {}

  std::size_t left() const { return rest_.size(); }
  std::string_view rest() const { return rest_; }
  std::string_view take(std::size_t count);
  std::int32_t number();
  /// A number of things of which each needs at least so many bytes.
  std::size_t count(std::size_t least_bytes);
  std::string text();
  VoxAttributes attributes();

 private:
  std::string_view rest_;
};

/// Bytes of a file for a message: in quotes, at most 24, others than printable ones as dots.
std::string printable(std::string_view bytes);

}  // namespace scarp
