// SPDX-License-Identifier: MIT
// Escapes text for the XML of virtual datasets.
#pragma once

#include <cpl_conv.h>
#include <cpl_string.h>

#include <string>

namespace scarp {

/// Escapes <, >, & and quotes.
inline std::string xml_text(const std::string& text) {
  char* escaped = CPLEscapeString(text.c_str(), static_cast<int>(text.size()), CPLES_XML);
  std::string result = escaped;
  CPLFree(escaped);
  return result;
}

}  // namespace scarp
