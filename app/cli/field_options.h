// SPDX-License-Identifier: MIT
// The options of every subcommand that makes a surface of a raster.
#pragma once

#include <CLI/CLI.hpp>

#include "scarp/scene/file/from_raster.h"

namespace scarp::cli {

/// What a subcommand can do beyond the border of a field: nothing, go round it, or be at its mirror images, too.
enum class BeyondBorders { none, wraps, mirrors };

/// Adds --exaggeration, --surface, --solid and, but for `none`, --wrap, each checked as it is read. `options` must live
/// until the subcommand has run.
void add_field_options(CLI::App& command, FieldOptions& options, BeyondBorders borders);

}  // namespace scarp::cli
