// SPDX-License-Identifier: MIT
// Texts as fields of CSV.
#pragma once

#include <string>
#include <string_view>

namespace scarp {

/// Appends a field as RFC 4180 defines it: in quotes if it contains a separator, a quote or a line break.
inline void append_csv_text(std::string& out, std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

}  // namespace scarp
