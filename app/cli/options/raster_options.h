// SPDX-License-Identifier: MIT
// The options of every subcommand that reads a raster.
#pragma once

#include <string>
#include <vector>

#include "app/options/command.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp::cli {

/// Help of IN for subcommands that take every input.
constexpr const char* kEveryFile =
    "raster (anything GDAL reads, .npy, .npz, .exr), voxels (.vox, .binvox, .qb, .kv6, .vxl, .vdb, .nvdb), mesh (.obj, "
    ".gltf, .glb) "
    "or scene (.json)";

/// Declares IN, one or several files or folders, as read_tiles() accepts. `kinds` is its help.
void add_raster_inputs(Command& command, std::vector<std::string>& inputs, const std::string& kinds,
                       bool required = true);

/// Declares --band, --window, --nodata, --scale and the other options that interpret a raster.
void add_raster_options(Command& command, RasterOptions& options);

}  // namespace scarp::cli
