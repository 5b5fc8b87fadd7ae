// SPDX-License-Identifier: MIT
// Numbers in options: several in one ("315,45", "1280x720"), those of a range, and whole ones of any size.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace scarp::cli {

/// The numbers between the separators. Throws Error "OPTION 'TEXT': expected FORM" when there are fewer than `least` or
/// more than `most`, or one of them is none.
std::vector<double> numbers_from(std::string_view text, char separator, std::size_t least, std::size_t most,
                                 std::string_view option, std::string_view form);

/// Which numbers an option takes. All are finite: NaN passes each comparison with a bound, so that one who only
/// compares takes it.
struct NumberRange {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above_least = false;  ///< the least one itself is none of them
};
/// The largest magnitude of options that say where and how high ground is: metres, map units, factors of heights.
/// Terrain functions end there, too (kFunctionReach, 2^30 m, 80 times the earth's diameter); what is larger is a slip,
/// and its picture would be empty.
constexpr double kMostOfGround = 0x1p30;
constexpr NumberRange kAnyNumber{}, kZeroOrMore{.least = 0}, kAboveZero{.least = 0, .above_least = true};

/// Returns a check of a text: empty when it is a number of the range, else what is wrong. Suits CLI::Option::check(),
/// whose own checks let NaN through and print the largest double with all its 309 digits.
std::function<std::string(const std::string& text)> number_in(const NumberRange& range);

/// numbers_from(), none of which has a larger magnitude than kMostOfGround.
std::vector<double> ground_numbers_from(std::string_view text, std::size_t least, std::size_t most,
                                        std::string_view option, std::string_view form);

/// Width and height in pixels, "WIDTHxHEIGHT". Throws Error as numbers_from() does; `example` is "1280x720".
std::array<int, 2> pixels_from(std::string_view text, std::string_view option, std::string_view example);

/// A length above 0 for messages, three digits of it at least and no power of ten: "0.25", "17.3", "3660".
std::string metres_text(double metres);

}  // namespace scarp::cli
