// SPDX-License-Identifier: MIT
// Values that Python passes by name.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>

#include "scarp/base/error.h"

namespace scarp::python {

template <class T>
struct Named {
  std::string_view name;
  T value;
};

/// Returns the value with this name. Throws Error listing the names; `argument` is the argument's, for messages.
template <class T, std::size_t N>
T find(const Named<T> (&table)[N], std::string_view name, std::string_view argument) {
  std::string names;
  for (const Named<T>& row : table) {
    if (row.name == name) return row.value;
    names += (names.empty() ? "" : ", ") + std::string(row.name);
  }
  throw Error(fmt::format("{}: unknown name '{}' (expected one of: {})", argument, name, names));
}

template <class T, std::size_t N>
std::string_view name_in(const Named<T> (&table)[N], T value) {
  for (const Named<T>& row : table)
    if (row.value == value) return row.name;
  return {};
}

}  // namespace scarp::python
