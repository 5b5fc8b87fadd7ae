// SPDX-License-Identifier: MIT
// MagicaVoxel files where a subcommand takes rasters, too.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scarp/source/vox_scene.h"

namespace scarp::cli {

/// Whether the inputs are one file whose name ends in .vox. Throws Error when such a file is among others.
bool is_vox_input(const std::vector<std::string>& inputs);

/// Adds --frame and --hidden. `options` must live until the subcommand has run.
void add_vox_options(CLI::App& command, VoxSceneOptions& options);

/// What is in a .vox file, for `scarp info`.
nlohmann::ordered_json describe_vox(const std::string& path, const VoxSceneOptions& options);
std::string vox_text_of(const nlohmann::ordered_json& info);

}  // namespace scarp::cli
