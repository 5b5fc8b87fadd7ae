// SPDX-License-Identifier: MIT
// Scene files on the command line.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/cli/look_options.h"
#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scene/file/scene_file.h"

namespace scarp::cli {

/// Whether the input is a scene. Throws Error if there are other inputs as well.
bool is_scene_input(const std::vector<std::string>& inputs);

/// Returns the settings with those of the file, its materials and its haze. Options in `given` ("--size") take
/// precedence.
PictureSettings picture_of(const SceneFile& file, PictureSettings settings, const std::vector<std::string>& given);
/// Adds the water and the fog of the file to the options, unless they were given. Throws Error naming the first given
/// option that has no effect without water or fog.
void take_environment(const SceneFile& file, const std::vector<std::string>& given, LookOptions& options);
/// The same for a view, if the file has no eye.
ViewSettings view_of(const SceneFile& file, ViewSettings view, const std::vector<std::string>& given);

/// Describes a scene: for --json, and as lines of text.
nlohmann::ordered_json describe_scene(const std::string& path);
std::string scene_text_of(const nlohmann::ordered_json& info);

}  // namespace scarp::cli
