// SPDX-License-Identifier: MIT
// Private to the station: a file that grows piece by piece, and becomes visible when it is complete.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "scarp/base/replace_file.h"

namespace scarp {

class OutputFile {
 public:
  /// Opens the file immediately; an empty path means standard output. Throws Error if the path is not writable.
  explicit OutputFile(const std::string& path);
  ~OutputFile();

  /// Appends bytes; they are buffered and written in large pieces. Throws Error if writing fails (disk full), as do the
  /// calls below.
  void add(std::string_view bytes);
  /// Writes the remaining bytes, then overwrites the beginning of the file with `header` unless it is empty, and
  /// renames the file. Standard output keeps its beginning: a pipe has none to go back to, and in a file there may be
  /// something before it. Only formats whose header never changes go there.
  void commit(std::string_view header = {});

  /// Throws Error "PATH: WHAT".
  [[noreturn]] void refuse(std::string_view what) const;

 private:
  struct Closer {
    void operator()(std::FILE* file) const;
  };

  void write(std::string_view bytes);

  std::string path_;
  std::unique_ptr<ReplaceFile> place_;  // null: standard output
  std::unique_ptr<std::FILE, Closer> file_;
  std::string waiting_;  // not written yet
};

}  // namespace scarp
