// SPDX-License-Identifier: MIT
// Facts about a terrain function, for `scarp info --function`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace scarp::cli {

/// `name_or_path`: as for --function; `extent`: side in metres of the examined square around the origin. Throws Error
/// for an unknown function or an extent out of range.
nlohmann::ordered_json describe_function(const std::string& name_or_path, double extent);
std::string function_text_of(const nlohmann::ordered_json& info);

}  // namespace scarp::cli
