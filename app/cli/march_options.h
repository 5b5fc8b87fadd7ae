// SPDX-License-Identifier: MIT
// The settings of all marches as options.
#pragma once

#include <CLI/CLI.hpp>

#include "scarp/march/marches.h"

namespace scarp::cli {

/// Adds an option for each setting of each march. `march` must live until the subcommand has run; validate() checks it.
void add_march_options(CLI::App& command, MarchSettings& march);

}  // namespace scarp::cli
