// SPDX-License-Identifier: MIT
// `scarp profile --path`: ground heights at stations along polylines.
#pragma once

#include <optional>
#include <string>

#include "app/cli/options/map_input.h"
#include "app/cli/options/place_file.h"
#include "app/options/command.h"

namespace scarp::cli {

struct ProfilePath {
  PlaceFile file;
  std::optional<double> spacing;  ///< metres; empty: the shorter side of a cell
};

/// Declares --path, --spacing, --layer and --skip-bad.
void add_profile_path_options(Command& command, ProfilePath& options);

/// Writes the table of all polylines to a .csv file, or to standard output if `output` is empty. Throws Error.
void write_path_profiles(const ProfilePath& options, const MapOptions& map, const std::string& output);

}  // namespace scarp::cli
