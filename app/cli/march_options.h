// SPDX-License-Identifier: MIT
// The settings of all marches as options.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "scarp/march/march_settings.h"

namespace scarp::cli {

/// Adds an option for each setting of each march. `march` must live until the subcommand has run; validate() checks it.
void add_march_options(CLI::App& command, MarchSettings& march);

/// Throws Error for the first setting that was given (names of options) and is one of other marches than `march`.
void require_settings_of(std::string_view march, const std::vector<std::string>& given, const MarchSettings& settings);

}  // namespace scarp::cli
