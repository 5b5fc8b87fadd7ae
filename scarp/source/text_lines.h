// SPDX-License-Identifier: MIT
// The lines of small text files.
#pragma once

#include <fmt/format.h>

#include <fstream>
#include <string>

#include "scarp/base/error.h"
#include "scarp/base/input_file.h"
#include "scarp/source/incomplete_file.h"

namespace scarp {

/// Calls take(text, number) for each line, without line ends and byte order mark; numbers start at 1. Throws Error
/// naming the file: not readable, or a Git LFS pointer.
template <class Take>
void for_lines(const std::string& path, const Take& take) {
  refuse_special_file(path, path + ": ");
  std::ifstream in(path);
  if (!in) throw Error(fmt::format("{}: cannot be opened", path));
  int number = 0;
  for (std::string text; std::getline(in, text);) {
    if (++number == 1) {
      if (text.starts_with(kLfsPointer)) throw Error(fmt::format("{}: {}", path, kLfsAdvice));
      if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    }
    if (text.ends_with('\r')) text.pop_back();
    take(text, number);
  }
  if (in.bad()) throw Error(fmt::format("{}: cannot be read", path));
}

}  // namespace scarp
