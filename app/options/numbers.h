// SPDX-License-Identifier: MIT
// Numbers in options: several in one value ("315,45", "1280x720"), ranges, and integers of any size.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace scarp::cli {

/// The numbers between the separators. Throws Error "OPTION 'TEXT': expected FORM" if there are fewer than `least` or
/// more than `most`, or one of them is not a number.
std::vector<double> numbers_from(std::string_view text, char separator, std::size_t least, std::size_t most,
                                 std::string_view option, std::string_view form);

/// The numbers that an option accepts. All are finite: NaN passes each comparison with a bound, so a plain range
/// comparison would accept it.
struct NumberRange {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above_least = false;  ///< excludes the minimum itself
};
/// The largest magnitude of options for positions and heights: metres, map units, factors of heights. Terrain functions
/// have the same limit (kFunctionReach, 2^30 m, 80 times the Earth's diameter); larger values are mistakes, and would
/// give empty pictures.
constexpr double kMostOfGround = 0x1p30;
constexpr NumberRange kAnyNumber{}, kZeroOrMore{.least = 0}, kAboveZero{.least = 0, .above_least = true};

/// Returns a check for a text. Its result is empty if the text is a number in the range, otherwise the error. For
/// CLI::Option::check(), whose own checks accept NaN and print the largest double with all its 309 digits.
std::function<std::string(const std::string& text)> number_in(const NumberRange& range);

/// numbers_from() for numbers with a magnitude of at most kMostOfGround.
std::vector<double> ground_numbers_from(std::string_view text, std::size_t least, std::size_t most,
                                        std::string_view option, std::string_view form);

/// Width and height in pixels, "WIDTHxHEIGHT", each within `range`. Throws Error as numbers_from() does; `example` is
/// "1280x720".
std::array<int, 2> pixels_from(std::string_view text, std::string_view option, std::string_view example,
                               const NumberRange& range = kAnyNumber);

/// Formats a length above 0 for messages, with at least three digits and no exponent: "0.25", "17.3", "3660".
std::string metres_text(double metres);

}  // namespace scarp::cli
