// SPDX-License-Identifier: MIT
// The options of every subcommand that makes a surface of a raster.
#pragma once

#include <CLI/CLI.hpp>

#include "scarp/scene/from_raster.h"

namespace scarp::cli {

/// Adds --exaggeration, --surface, --wrap and --solid, each checked as it is read. `options` must live until the
/// subcommand has run.
void add_field_options(CLI::App& command, FieldOptions& options);

}  // namespace scarp::cli
