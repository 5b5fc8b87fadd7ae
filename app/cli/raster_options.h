// SPDX-License-Identifier: MIT
// The options of every subcommand that reads a raster.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "scarp/source/raster_options.h"

namespace scarp::cli {

/// Adds IN, one or several files or folders: what read_tiles() takes. `inputs` must live until the subcommand has run.
CLI::Option* add_raster_inputs(CLI::App& command, std::vector<std::string>& inputs);

/// Adds --band, --window, --nodata, --scale, --offset, --height-range, --unit, --crs, --bounds, --encoding, --raw,
/// --channel and --key. `options` must live until the subcommand has run. `crs_option` replaces --crs where that means
/// something else.
void add_raster_options(CLI::App& command, RasterOptions& options, const std::string& crs_option = "--crs");

}  // namespace scarp::cli
