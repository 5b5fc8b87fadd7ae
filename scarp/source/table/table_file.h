// SPDX-License-Identifier: MIT
// Private to the station: shared by the readers of text tables.
#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

namespace scarp {

/// Returns the bytes of a file, or of standard input if `path` is "-". Throws Error without the file's name: missing,
/// a directory or a device, a Git LFS pointer, not readable to its end.
std::string table_bytes(const std::string& path);

/// Returns a field in a form that fits in a one-line message.
std::string shown_field(std::string_view text);

/// Returns the number in a field. Throws Error naming line and column if the field is not a finite number.
double finite_field(std::string_view field, std::string_view column, std::int64_t line);

/// Parses a whole field; returns whether it is a number.
template <class Number>
bool parse_field(std::string_view text, Number& number) {
  // std::from_chars accepts no plus sign.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && rest == text.data() + text.size() && !text.empty();
}

}  // namespace scarp
