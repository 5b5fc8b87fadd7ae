// SPDX-License-Identifier: MIT
// What is known of a terrain function, for `scarp info --function`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace scarp::cli {

/// `name_or_path` as --function takes it; `extent`: metres of the square about the origin that is looked at. Throws
/// Error for an unknown function or an extent out of its range.
nlohmann::ordered_json describe_function(const std::string& name_or_path, double extent);
std::string function_text_of(const nlohmann::ordered_json& info);

}  // namespace scarp::cli
