// SPDX-License-Identifier: MIT
// What the pixels of a map depend on, as text: --resume goes on only with the same text, and scarp merge joins only
// parts with the same one.
#pragma once

#include <string>
#include <vector>

#include "app/cli/options/map_input.h"
#include "app/options/command.h"
#include "scarp/source/table/place_table.h"

namespace scarp::cli {

/// Returns the version, the subcommand with the typed options that change pixels, the raster's shape and place, and the
/// size and time of every file. Equal for all parts of a map, and on any machine. `more`: files and contents of tables
/// that the subcommand has read.
std::string map_identity(const Command& command, const MapInput& input, const std::vector<std::string>& more);

/// Returns a file's name without its folder, its size and time, for map_identity().
std::string file_identity(const std::string& path);

/// Returns a line that changes with the places and columns of a table, for map_identity(). The table may come from
/// several files, or from standard input.
std::string table_identity(const PlaceTable& table);

}  // namespace scarp::cli
