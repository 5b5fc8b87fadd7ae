// SPDX-License-Identifier: MIT
#pragma once

#include <cpl_port.h>

#include <string>
#include <string_view>

namespace scarp {

/// Whether the name ends in `extension` (".npy"), in any case.
inline bool has_extension(const std::string& path, std::string_view extension) {
  return path.size() >= extension.size() && EQUAL(path.c_str() + path.size() - extension.size(), extension.data());
}

}  // namespace scarp
