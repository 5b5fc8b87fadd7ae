// SPDX-License-Identifier: MIT
// The options of every subcommand that reads a raster.
#pragma once

#include <CLI/CLI.hpp>

#include "scarp/source/raster_options.h"

namespace scarp::cli {

/// Adds --band, --window, --nodata, --scale, --offset, --unit, --crs, --bounds and --key. `options` must live until the
/// subcommand has run.
void add_raster_options(CLI::App& command, RasterOptions& options);

}  // namespace scarp::cli
