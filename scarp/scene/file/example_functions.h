// SPDX-License-Identifier: MIT
// Named example terrain functions, and functions from files.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scarp/field/function_node.h"

namespace scarp {

struct ExampleFunction {
  std::string_view name, description;  ///< one line
  std::string_view json;               ///< the function itself, in the format of function files (function_json.h)
};

std::span<const ExampleFunction> example_functions();
/// Throws Error listing the names if the function is unknown.
Function example_function(std::string_view name);

/// Returns the function named in example_functions(), or else read from a JSON file at this path. Throws Error if the
/// file is unknown, is not JSON (with the line), or is not a function (with the position in the file).
Function read_function(const std::string& name_or_path);

}  // namespace scarp
