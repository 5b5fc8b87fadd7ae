// SPDX-License-Identifier: MIT
#include "scarp/source/raster/raw_format.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>

#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr std::int64_t kLargestOffset = std::int64_t{1} << 62;

// The remainder of a text that is parsed from left to right.
class Rest {
 public:
  explicit Rest(std::string_view text) : text_(text) {}

  bool take(std::string_view word) {
    if (!text_.starts_with(word)) return false;
    text_.remove_prefix(word.size());
    return true;
  }
  // Parses an integer in [least, most] that consists only of digits.
  bool take_number(std::int64_t least, std::int64_t most, std::int64_t& number) {
    if (text_.empty() || text_[0] < '0' || text_[0] > '9') return false;
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), number);
    if (error != std::errc() || number < least || number > most) return false;
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return true;
  }
  bool empty() const { return text_.empty(); }

 private:
  std::string_view text_;
};

struct RawType {
  std::string_view name;
  char kind;
  int bytes;
};
constexpr RawType kTypes[] = {{"u8", 'u', 1},  {"i8", 'i', 1},  {"u16", 'u', 2}, {"i16", 'i', 2},
                              {"u32", 'u', 4}, {"i32", 'i', 4}, {"f32", 'f', 4}, {"f64", 'f', 8}};

bool take_type(Rest& rest, RawFormat& format) {
  for (const RawType& type : kTypes) {
    if (!rest.take(type.name)) continue;
    format.kind = type.kind;
    format.bytes = type.bytes;
    format.big_endian = rest.take("be");
    return format.big_endian || rest.take("le") || type.bytes == 1;
  }
  return false;
}

bool parse(std::string_view text, RawFormat& format) {
  Rest rest(text);
  std::int64_t cols = 0, rows = 0;
  constexpr std::int64_t kMost = std::numeric_limits<int>::max();
  if (!rest.take_number(1, kMost, cols) || !rest.take("x") || !rest.take_number(1, kMost, rows) || !rest.take(":"))
    return false;
  format.cols = static_cast<int>(cols);
  format.rows = static_cast<int>(rows);
  if (!take_type(rest, format)) return false;
  format.has_offset = rest.take("+");
  if (format.has_offset && !rest.take_number(0, kLargestOffset, format.offset)) return false;
  // GDAL counts the bytes of a row in 32 bits.
  return rest.empty() && cols <= kMost / format.bytes;
}

}  // namespace

RawFormat parse_raw_format(std::string_view text) {
  RawFormat format;
  if (!parse(text, format)) {
    throw Error(
        fmt::format("--raw '{}': expected COLSxROWS:TYPE[+OFFSET], TYPE one of u8 i8 u16 i16 u32 i32 f32 f64 "
                    "followed by le or be, OFFSET the size of a header, for example 4097x4097:u16le",
                    text));
  }
  return format;
}

std::string text_of(const RawFormat& format) {
  return fmt::format("{}x{}:{}{}{}{}", format.cols, format.rows, format.kind, 8 * format.bytes,
                     format.bytes == 1 ? "" : (format.big_endian ? "be" : "le"),
                     format.has_offset ? fmt::format("+{}", format.offset) : "");
}

}  // namespace scarp
