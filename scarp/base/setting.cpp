// SPDX-License-Identifier: MIT
#include "scarp/base/setting.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scarp/base/error.h"

namespace scarp {

void require_setting(std::string_view subject, bool good, std::string_view what, double value, std::string_view range) {
  if (!good) throw Error(fmt::format("{}: {} is {} (must be {})", subject, what, value, range));
}

std::size_t find_setting(std::string_view subject, std::span<const std::string_view> names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw Error(fmt::format("{} '{}': unknown (available: {})", subject, name, fmt::join(names, ", ")));
  }
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace scarp
