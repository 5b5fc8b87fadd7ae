// SPDX-License-Identifier: MIT
#include "scarp/source/voxel/binvox.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "scarp/base/error.h"
#include "scarp/source/incomplete_file.h"
#include "scarp/source/voxel/vox_bytes.h"
#include "scarp/source/whole_file.h"

namespace scarp {
namespace {

constexpr std::string_view kBinvoxMagic = "#binvox";
constexpr std::size_t kLongestLine = 256;  // in a header
constexpr int kMostLines = 64;

// A line of the header, without its end; accepts "\r\n".
std::string_view take_line(std::string_view& bytes) {
  const std::size_t end = bytes.substr(0, kLongestLine).find('\n');
  if (end == std::string_view::npos) throw Error("truncated header, no line 'data'");
  std::string_view line = bytes.substr(0, end);
  bytes.remove_prefix(end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

template <class Number>
std::array<Number, 3> numbers(std::string_view line, std::string_view what, std::size_t count, const char* expected) {
  std::array<Number, 3> found{};
  std::string_view rest = line.substr(what.size());
  bool good = true;
  for (std::size_t i = 0; i < count; ++i) {
    rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), found[i]);
    good = good && error == std::errc();
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  }
  if (!good || rest.find_first_not_of(' ') != std::string_view::npos)
    throw Error(fmt::format("header line {} (expected '{} {}')", printable(line), what, expected));
  return found;
}

bool says(std::string_view line, std::string_view word) {
  return line == word || (line.starts_with(word) && line.substr(word.size()).starts_with(' '));
}

Binvox parse_header(std::string_view& bytes) {
  const std::string_view first = take_line(bytes);
  if (first != "#binvox 1")
    throw Error(fmt::format("version {} is not supported (expected '#binvox 1')", printable(first)));
  Binvox binvox;
  bool sized = false;
  for (int line_number = 0;; ++line_number) {
    if (line_number == kMostLines) throw Error("header has no line 'data'");
    const std::string_view line = take_line(bytes);
    if (line == "data") break;
    if (says(line, "dim")) {
      const auto [depth, height, width] = numbers<std::int64_t>(line, "dim", 3, "DEPTH HEIGHT WIDTH");
      for (const std::int64_t side : {depth, height, width}) {
        if (side < 1 || side > Binvox::kMaxSide)
          throw Error(fmt::format("header line {} (sides must be 1 to {})", printable(line), Binvox::kMaxSide));
      }
      binvox.size = {depth, width, height};
      sized = true;
    } else if (says(line, "translate")) {
      const auto [x, y, z] = numbers<double>(line, "translate", 3, "X Y Z");
      binvox.translate = {x, y, z};
    } else if (says(line, "scale")) {
      binvox.scale = numbers<double>(line, "scale", 1, "S")[0];
    } else if (!line.starts_with('#')) {
      throw Error(fmt::format("unknown header line {} (expected dim, translate, scale or data)", printable(line)));
    }
  }
  if (!sized) throw Error("header has no line 'dim DEPTH HEIGHT WIDTH'");
  if (!std::isfinite(binvox.translate.x + binvox.translate.y + binvox.translate.z + binvox.scale))
    throw Error("translate and scale of the header are not finite");
  return binvox;
}

std::uint64_t volume(const ivec3& size) {
  return static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) * static_cast<std::uint64_t>(size.z);
}

Binvox parse_content(std::string_view bytes) {
  Binvox binvox = parse_header(bytes);
  const std::uint64_t voxels = volume(binvox.size);
  std::uint64_t counted = 0;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const auto value = static_cast<std::uint8_t>(bytes[i]), count = static_cast<std::uint8_t>(bytes[i + 1]);
    if (value > 1 || count == 0)
      throw Error(fmt::format("run {} is {} voxels of {} (expected 1 to 255 of 0 or 1)", i / 2, count, value));
    counted += count;
  }
  if (counted != voxels) {
    throw Error(fmt::format("runs contain {} voxels instead of {} x {} x {} = {}{}", counted, binvox.size.x,
                            binvox.size.y, binvox.size.z, voxels, counted < voxels ? " (truncated file?)" : ""));
  }
  if (bytes.size() % 2 != 0) throw Error("ends within a run (truncated file?)");
  binvox.clear();
  std::uint64_t at = 0;
  for (std::size_t i = 0; at < voxels; i += 2) {
    const auto count = static_cast<std::uint8_t>(bytes[i + 1]);
    if (bytes[i] != 0) {
      for (std::uint64_t v = at; v < at + count; ++v) binvox.bits[v / 64] |= std::uint64_t{1} << v % 64;
    }
    at += count;
  }
  return binvox;
}

}  // namespace

void Binvox::clear() { bits.assign((volume(size) + 63) / 64, 0); }

Binvox parse_binvox(std::string_view bytes) {
  if (!bytes.starts_with(kBinvoxMagic)) {
    throw Error(fmt::format("not a binvox file: begins with {} instead of '#binvox'",
                            printable(bytes.substr(0, kBinvoxMagic.size()))));
  }
  return advising("write it again with binvox", [&] { return parse_content(bytes); });
}

Binvox read_binvox(const std::string& path) {
  try {
    return parse_binvox(whole_file(path, kBinvoxMagic));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

std::string binvox_bytes(const Binvox& binvox) {
  std::string bytes =
      fmt::format("#binvox 1\ndim {} {} {}\ntranslate {} {} {}\nscale {}\ndata\n", binvox.size.x, binvox.size.z,
                  binvox.size.y, binvox.translate.x, binvox.translate.y, binvox.translate.z, binvox.scale);
  const std::uint64_t voxels = volume(binvox.size);
  const auto value = [&](std::uint64_t v) { return binvox.bits[v / 64] >> v % 64 & 1; };
  for (std::uint64_t begin = 0; begin < voxels;) {
    std::uint64_t end = begin + 1;
    while (end < voxels && end - begin < 255 && value(end) == value(begin)) ++end;
    bytes += static_cast<char>(value(begin));
    bytes += static_cast<char>(static_cast<std::uint8_t>(end - begin));
    begin = end;
  }
  return bytes;
}

void write_binvox(const std::string& path, const Binvox& binvox) { write_whole_file(path, binvox_bytes(binvox)); }

}  // namespace scarp
