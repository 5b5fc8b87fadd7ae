// SPDX-License-Identifier: MIT
// Atomic file output: writes a temporary file, then renames it.
#pragma once

#include <string>

namespace scarp {

struct NotedName;

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
  NotedName* noted_ = nullptr;  // the temporary name, for remove_temporary_files()
};

/// A hidden, empty folder beside `path`, for writers that choose the names of further files by the name of the first.
/// The destructor deletes the folder with all that it contains.
class TemporaryFolder {
 public:
  /// Throws Error naming `path` if the folder cannot be created.
  explicit TemporaryFolder(const std::string& path);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& name() const { return name_; }

 private:
  std::string name_;
  NotedName* noted_ = nullptr;
};

/// Deletes all temporary files, and temporary folders with the files in them. For programs that end without running
/// destructors: safe in a signal handler, whatever other threads do. The program must end after this call.
void remove_temporary_files() noexcept;

}  // namespace scarp
