// SPDX-License-Identifier: MIT
#include "app/cli/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "scarp/base/error.h"

namespace scarp::cli {

std::vector<double> numbers_from(std::string_view text, char separator, std::size_t least, std::size_t most,
                                 std::string_view option, std::string_view form) {
  std::vector<double> numbers;
  bool good = true;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    double number = 0;
    const auto [rest, error] = std::from_chars(text.data() + begin, text.data() + end, number);
    good = good && error == std::errc() && rest == text.data() + end && std::isfinite(number);
    numbers.push_back(number);
    begin = end + 1;
  }
  if (!good || numbers.size() < least || numbers.size() > most) {
    throw Error(fmt::format("{} '{}': expected {}", option, text, form));
  }
  return numbers;
}

std::string check_whole_number(const std::string& text, std::uint64_t most) {
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error == std::errc() && rest == end && number <= most) return {};
  return fmt::format("'{}': expected a whole number from 0 to {}", text, most);
}

}  // namespace scarp::cli
