// SPDX-License-Identifier: MIT
// Atomic file output: writes a temporary file, then renames it.
#pragma once

#include <string>

namespace scarp {

/// Reserves a temporary name in the folder of `path`, with the same extension for writers that choose a format by it.
/// commit() renames it to `path`, with the permissions of the file that it replaces. Without commit() the destructor
/// deletes the temporary file.
class ReplaceFile {
 public:
  /// Throws Error if `path` is empty, is a directory, or is in a folder that does not exist or is not writable.
  explicit ReplaceFile(std::string path);
  ~ReplaceFile();
  ReplaceFile(const ReplaceFile&) = delete;
  ReplaceFile& operator=(const ReplaceFile&) = delete;

  /// Path to write to.
  const std::string& temporary_path() const { return temporary_; }
  /// Throws Error if the file cannot be renamed.
  void commit();

 private:
  std::string path_;
  std::string temporary_;
  struct Noted;
  Noted* noted_ = nullptr;  // the temporary name, for remove_temporary_files()

  friend void remove_temporary_files() noexcept;
};

/// Deletes all temporary files. For programs that end without running destructors: safe in a signal handler, whatever
/// other threads do. The program must end after this call.
void remove_temporary_files() noexcept;

}  // namespace scarp
