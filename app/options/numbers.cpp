// SPDX-License-Identifier: MIT
#include "app/options/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

std::string form_of(const NumberRange& range) {
  const bool least = std::isfinite(range.least), most = std::isfinite(range.most);
  if (least && most && range.above_least)
    return fmt::format("a number above {} and at most {}", range.least, range.most);
  if (least && most) return fmt::format("a number from {} to {}", range.least, range.most);
  if (least && range.above_least) return fmt::format("a finite number above {}", range.least);
  if (least) return fmt::format("a finite number, {} or more", range.least);
  return "a finite number";
}

}  // namespace

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

std::vector<double> ground_numbers_from(std::string_view text, std::size_t least, std::size_t most,
                                        std::string_view option, std::string_view form) {
  std::vector<double> numbers = numbers_from(text, ',', least, most, option, form);
  for (const double number : numbers) {
    if (std::abs(number) > kMostOfGround)
      throw Error(fmt::format("{} '{}': expected numbers from {} to {}", option, text, -kMostOfGround, kMostOfGround));
  }
  return numbers;
}

std::array<int, 2> pixels_from(std::string_view text, std::string_view option, std::string_view example,
                               const NumberRange& range) {
  constexpr double kMost = 1e9;  // catches typing errors; the limit of pictures is far lower
  const std::string form =
      fmt::format("WIDTHxHEIGHT in pixels{}, for example {}",
                  std::isfinite(range.most) ? fmt::format(", {} to {} each", range.least, range.most) : "", example);
  const auto numbers = numbers_from(text, 'x', 2, 2, option, form);
  for (const double number : numbers) {
    if (number != std::floor(number) || std::abs(number) > kMost || number < range.least || number > range.most)
      throw Error(fmt::format("{} '{}': expected {}", option, text, form));
  }
  return {static_cast<int>(numbers[0]), static_cast<int>(numbers[1])};
}

std::function<std::string(const std::string& text)> number_in(const NumberRange& range) {
  return [range](const std::string& text) -> std::string {
    // Parses as CLI11 does.
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    if (!text.empty() && *end == '\0' && std::isfinite(number) && number <= range.most &&
        (range.above_least ? number > range.least : number >= range.least))
      return {};
    return fmt::format("'{}': expected {}", text, form_of(range));
  };
}

std::string metres_text(double metres) {
  // With three digits, numbers from 1000 on would be printed with an exponent.
  return metres < 100 ? fmt::format("{:.3g}", metres) : fmt::format("{:.0f}", metres);
}

}  // namespace scarp::cli
