// SPDX-License-Identifier: MIT
// The options of every subcommand that reads a raster.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "scarp/source/raster_options.h"

namespace scarp::cli {

/// Adds --band, --window, --nodata, --scale, --offset, --unit, --crs, --bounds and --key. `options` must live until the
/// subcommand has run. `crs_option` replaces --crs where that means something else.
void add_raster_options(CLI::App& command, RasterOptions& options, const std::string& crs_option = "--crs");

}  // namespace scarp::cli
