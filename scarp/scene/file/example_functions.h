// SPDX-License-Identifier: MIT
// Terrain functions to look at and to measure by, by name; and functions from files.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scarp/field/function_node.h"

namespace scarp {

struct ExampleFunction {
  std::string_view name, description;  ///< one line
  std::string_view json;               ///< the function itself, as a file would have it (function_json.h)
};

std::span<const ExampleFunction> example_functions();
/// Throws Error listing the names when there is no such function.
Function example_function(std::string_view name);

/// A name of example_functions(), or else the path of a JSON file that holds one function. Throws Error: no such file,
/// not JSON (with the line), or not a function, with the place in the file.
Function read_function(const std::string& name_or_path);

}  // namespace scarp
