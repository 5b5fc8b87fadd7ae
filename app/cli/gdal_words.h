// SPDX-License-Identifier: MIT
// Command lines of GDAL's programs: their flags have one dash and several letters, which this program's parser would
// read as several flags.
#pragma once

#include <string>
#include <vector>

namespace scarp::cli {

/// Replaces gdal_viewshed's flags in the words after `scarp viewshed` or `scarp shadow`. If there is such a flag and no
/// -o, the last word is the output. Throws WrongUsage for -ox without -oy, and for a flag without its value.
std::vector<std::string> without_gdal_words(const std::vector<std::string>& words);

}  // namespace scarp::cli
