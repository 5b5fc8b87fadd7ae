// SPDX-License-Identifier: MIT
// File name extensions in lower case.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace scarp {

/// Returns the text with ASCII letters in lower case.
inline std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Returns the extension of a path in lower case, with its dot: ".tif" for "a/B.TIF"; "" if there is none.
inline std::string extension_of(const std::string& path) {
  return lower_case(std::filesystem::path(path).extension().string());
}

}  // namespace scarp
