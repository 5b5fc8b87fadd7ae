// SPDX-License-Identifier: MIT
// Numbers in options: several in one ("315,45", "1280x720"), and whole ones of any size.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scarp::cli {

/// The numbers between the separators. Throws Error "OPTION 'TEXT': expected FORM" when there are fewer than `least` or
/// more than `most`, or one of them is none.
std::vector<double> numbers_from(std::string_view text, char separator, std::size_t least, std::size_t most,
                                 std::string_view option, std::string_view form);

/// For CLI::Option::check(): empty when the text is a whole number from 0 to `most`, else what is wrong. CLI11 itself
/// takes a number that is too large for the largest there is.
std::string check_whole_number(const std::string& text, std::uint64_t most);

}  // namespace scarp::cli
