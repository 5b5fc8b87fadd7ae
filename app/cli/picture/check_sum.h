// SPDX-License-Identifier: MIT
// FNV-1a (Fowler, Noll, Vo) over words of 8 bytes: enough to tell a strip from one that was cut off, and the inputs of
// a map from others. No protection against forgery.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace scarp::cli {

class CheckSum {
 public:
  void add(std::span<const std::byte> bytes) {
    constexpr std::uint64_t kPrime = 1099511628211;
    while (!bytes.empty()) {
      const std::size_t count = std::min<std::size_t>(bytes.size(), 8);
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data(), count);
      value_ = (value_ ^ word) * kPrime;
      bytes = bytes.subspan(count);
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037ull;
};

inline std::uint64_t check_sum_of(std::string_view text) {
  CheckSum sum;
  sum.add(std::as_bytes(std::span(text.data(), text.size())));
  return sum.value();
}

}  // namespace scarp::cli
