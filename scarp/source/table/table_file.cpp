// SPDX-License-Identifier: MIT
#include "scarp/source/table/table_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "scarp/base/error.h"
#include "scarp/base/input_file.h"
#include "scarp/source/incomplete_file.h"
#include "scarp/source/table/csv_rows.h"

namespace scarp {
namespace {

struct InputCloser {
  void operator()(std::FILE* file) const {
    if (file != stdin) std::fclose(file);
  }
};

}  // namespace

std::string table_bytes(const std::string& path) {
  std::error_code ignored;
  if (path != "-" && std::filesystem::is_directory(path, ignored)) throw Error("is a directory (name a file)");
  if (path != "-") refuse_special_file(path);
  const std::unique_ptr<std::FILE, InputCloser> file(path == "-" ? stdin : std::fopen(path.c_str(), "rb"));
  if (!file) throw Error(fmt::format("cannot be opened: {}", std::strerror(errno)));
  constexpr std::size_t kPiece = 1 << 20;
  std::string bytes;
  for (;;) {
    const std::size_t size = bytes.size();
    bytes.resize(size + kPiece);
    const std::size_t got = std::fread(bytes.data() + size, 1, kPiece, file.get());
    bytes.resize(size + got);
    if (got < kPiece) break;
  }
  if (std::ferror(file.get())) throw Error(fmt::format("cannot be read: {}", std::strerror(errno)));
  refuse_lfs_pointer(bytes);
  return bytes;
}

std::string shown_field(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string result(text.substr(0, kLongest));
  std::replace_if(
      result.begin(), result.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text.size() > kLongest ? result + "..." : result;
}

double finite_field(std::string_view field, std::string_view column, std::int64_t line) {
  double number = 0;
  if (!parse_field(trimmed(field), number) || !std::isfinite(number))
    throw Error(fmt::format("line {}: {} '{}' is not a finite number", line, column, shown_field(field)));
  return number;
}

}  // namespace scarp
