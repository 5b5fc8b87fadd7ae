// SPDX-License-Identifier: MIT
// Terrain functions where `scarp render` takes files: --function and --preset.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "scarp/march/march_settings.h"

namespace scarp::cli {

/// Without --march.
constexpr const char* kFunctionMarch = "lipschitz-local";

struct FunctionInput {
  std::string function;  // a name or a file; empty: none
  std::string preset;
  double extent = 6000;
};

/// Adds --function and --extent. `input` must live until the subcommand has run.
void add_function_option(CLI::App& command, FunctionInput& input, const std::string& extent);
/// These and --preset. `march` and `settings` are where --march and its settings go, and those of a preset with them:
/// add this before them, so that what is typed counts more. All must live until the subcommand has run.
void add_function_options(CLI::App& command, FunctionInput& input, std::string& march, MarchSettings& settings);

}  // namespace scarp::cli
