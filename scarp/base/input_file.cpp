// SPDX-License-Identifier: MIT
#include "scarp/base/input_file.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "scarp/base/error.h"

namespace scarp {

void refuse_special_file(const std::string& path, const std::string& subject) {
  constexpr std::string_view kOpenStreams[] = {"/dev/stdin", "/dev/fd/", "/proc/self/fd/"};
  const auto begins = [&](std::string_view name) { return path.starts_with(name); };
  if (std::any_of(std::begin(kOpenStreams), std::end(kOpenStreams), begins)) return;
  std::error_code unknown;
  switch (std::filesystem::status(path, unknown).type()) {
    case std::filesystem::file_type::fifo:
      throw Error(subject + "is a pipe (copy its contents to a file first)");
    case std::filesystem::file_type::socket:
    case std::filesystem::file_type::character:
    case std::filesystem::file_type::block:
      throw Error(subject + "is a device or another special file (name a regular file)");
    default:
      return;
  }
}

}  // namespace scarp
