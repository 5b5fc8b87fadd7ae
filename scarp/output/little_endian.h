// SPDX-License-Identifier: MIT
// Private to the station: converts numbers to bytes, least significant first, on every machine.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

namespace scarp {

template <class Number>
void append_little_endian(std::string& out, Number number) {
  if constexpr (std::is_same_v<Number, double>) {
    append_little_endian(out, std::bit_cast<std::uint64_t>(number));
  } else if constexpr (std::is_same_v<Number, float>) {
    append_little_endian(out, std::bit_cast<std::uint32_t>(number));
  } else {
    auto bits = static_cast<std::make_unsigned_t<Number>>(number);
    char bytes[sizeof(Number)];
    for (std::size_t i = 0; i < sizeof(Number); ++i) bytes[i] = static_cast<char>(bits >> 8 * i & 0xff);
    out.append(bytes, sizeof(Number));
  }
}

}  // namespace scarp
