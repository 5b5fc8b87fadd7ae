// SPDX-License-Identifier: MIT
#include "scarp/source/whole_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>

#include "scarp/base/error.h"
#include "scarp/base/input_file.h"
#include "scarp/base/replace_file.h"

namespace scarp {
namespace {

// Longer than any header here.
constexpr std::uint64_t kFirstBytes = 64;

}  // namespace

std::string whole_file(const std::string& path,
                       const std::function<bool(std::string_view first, std::uint64_t size)>& believe) {
  refuse_special_file(path);
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) throw Error("cannot be opened");
  const std::streamoff length = in.tellg();
  if (length < 0) throw Error("cannot be read (is it a file?)");
  const auto size = static_cast<std::uint64_t>(length);
  in.seekg(0);
  std::string bytes(std::min(size, kFirstBytes), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in) throw Error("cannot be read (is it a file?)");
  if (!believe(bytes, size)) return bytes;
  const std::size_t begin = bytes.size();
  bytes.resize(size);
  in.read(bytes.data() + begin, static_cast<std::streamsize>(size - begin));
  if (!in) throw Error("cannot be read to its end");
  return bytes;
}

std::string whole_file(const std::string& path, std::string_view magic) {
  return whole_file(path, [&](std::string_view first, std::uint64_t) { return first.starts_with(magic); });
}

void write_whole_file(const std::string& path, std::string_view bytes) {
  ReplaceFile place(path);
  std::ofstream out(place.temporary_path(), std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw Error(fmt::format("{}: cannot be written (is the disk full?)", path));
  place.commit();
}

}  // namespace scarp
