// SPDX-License-Identifier: MIT
// Output that is whole or not there: written beside its place, then renamed into it.
#pragma once

#include <string>

namespace scarp {

/// Reserves a temporary name in the folder of `path`, with the same extension, so that writers which go by the name
/// work. commit() moves it into place in one step, with the permissions of the file that it replaces; without commit()
/// the destructor removes what was written.
class ReplaceFile {
 public:
  /// Throws Error when `path` is empty, is a directory, or lies in a folder that does not exist or cannot be written.
  explicit ReplaceFile(std::string path);
  ~ReplaceFile();
  ReplaceFile(const ReplaceFile&) = delete;
  ReplaceFile& operator=(const ReplaceFile&) = delete;

  /// Where to write.
  const std::string& temporary_path() const { return temporary_; }
  /// Throws Error when the file cannot be moved into place.
  void commit();

 private:
  std::string path_;
  std::string temporary_;
  struct Noted;
  Noted* noted_ = nullptr;  // the temporary name, for remove_temporary_files()

  friend void remove_temporary_files() noexcept;
};

/// Removes what is under all temporary names, for a program that ends at once, without destructors: it may be called in
/// a handler of signals, whatever other threads do, and the program must end after it.
void remove_temporary_files() noexcept;

}  // namespace scarp
