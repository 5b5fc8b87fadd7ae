// SPDX-License-Identifier: MIT
// Structures of the C interface that may grow: reads those of older and newer callers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "scarp/c/failure.h"

namespace scarp::c {

/// Larger sizes are garbage.
constexpr std::size_t kLargestStructure = 4096;

inline std::size_t size_of(const void* structure, std::size_t first_size, const char* name) {
  if (!structure) throw Error(fmt::format("{}: is NULL", name));
  std::size_t size = 0;
  std::memcpy(&size, structure, sizeof size);
  if (size < first_size || size > kLargestStructure)
    throw Error(fmt::format("{}: struct_size is {} (set it to sizeof(scarp_{}))", name, size, name));
  return size;
}

/// Copies a structure of settings. Members that the caller does not know are 0. Throws Error if the pointer is null,
/// struct_size is smaller than `first_size`, that of the first version, or a member unknown to this version is set.
template <class T>
T read(const T* given, const char* name, std::size_t first_size = sizeof(T)) {
  const std::size_t size = size_of(given, first_size, name);
  T own{};
  std::memcpy(&own, given, std::min(size, sizeof(T)));
  const auto* bytes = reinterpret_cast<const unsigned char*>(given);
  if (size > sizeof(T) && std::any_of(bytes + sizeof(T), bytes + size, [](unsigned char byte) { return byte != 0; }))
    throw Error(fmt::format("{}: a member is set that this version of Scarp does not know", name));
  return own;
}

/// Fills a structure of answers as far as the caller knows it. Throws as read() does.
template <class T>
void write(T own, T* given, const char* name, std::size_t first_size = sizeof(T)) {
  own.struct_size = size_of(given, first_size, name);
  std::memcpy(given, &own, std::min(own.struct_size, sizeof(T)));
}

}  // namespace scarp::c
