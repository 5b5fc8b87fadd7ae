// SPDX-License-Identifier: MIT
// Looks up a march in a table by its name.
#pragma once

#include <fmt/format.h>

#include <span>
#include <string>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/march/march_entry.h"

namespace scarp {

/// Throws Error listing the names if the table has no row of this name.
template <class Entry>
const Entry& find_entry(std::span<const Entry> table, std::string_view name) {
  std::string names;
  for (const Entry& entry : table) {
    if (entry.name == name) return entry;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", entry.name);
  }
  throw Error(fmt::format("march '{}': unknown (available: {})", name, names));
}

/// "the march NAME records no steps (use ...)", with the marches of the table that do.
template <class Entry>
std::string records_nothing(std::span<const Entry> table, std::string_view name) {
  std::string names;
  for (const Entry& entry : table) {
    if (entry.traced) names += fmt::format("{}{}", names.empty() ? "" : ", ", entry.name);
  }
  return fmt::format("the march {} records no steps (use {})", name, names);
}

}  // namespace scarp
