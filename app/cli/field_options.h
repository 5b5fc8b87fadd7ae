// SPDX-License-Identifier: MIT
// The options of every subcommand that makes a surface of a raster.
#pragma once

#include "app/cli/command.h"
#include "scarp/scene/file/from_raster.h"

namespace scarp::cli {

/// What a subcommand can do beyond the border of a field: nothing, go round it, or be at its mirror images, too.
enum class BeyondBorders { none, wraps, mirrors };

/// Declares --exaggeration, --surface, --solid and, except for `none`, --wrap.
void add_field_options(Command& command, FieldOptions& options, BeyondBorders borders);

}  // namespace scarp::cli
