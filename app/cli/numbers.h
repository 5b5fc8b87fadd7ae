// SPDX-License-Identifier: MIT
// Options that hold several numbers: "315,45", "1280x720".
#pragma once

#include <string_view>
#include <vector>

namespace scarp::cli {

/// The numbers between the separators. Throws Error "OPTION 'TEXT': expected FORM" when there are fewer than `least` or
/// more than `most`, or one of them is none.
std::vector<double> numbers_from(std::string_view text, char separator, std::size_t least, std::size_t most,
                                 std::string_view option, std::string_view form);

}  // namespace scarp::cli
