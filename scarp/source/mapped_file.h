// SPDX-License-Identifier: MIT
// Memory-mapped files: the system reads pages when they are first used, and may drop them again.
#pragma once

#include <string>
#include <string_view>

namespace scarp {

/// A file mapped for reading. If the file is truncated while it is mapped, the process ends with SIGBUS, as with any
/// mapping.
class MappedFile {
 public:
  /// Throws Error, without the path: missing, not a file, cannot be mapped.
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const { return bytes_; }

 private:
  std::string_view bytes_;
};

}  // namespace scarp
