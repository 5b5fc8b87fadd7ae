// SPDX-License-Identifier: MIT
// Scene files on the command line.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/cli/options/render_options.h"
#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/picture_request.h"
#include "scarp/scene/file/scene_file.h"

namespace scarp::cli {

/// Whether the input is a scene. Throws Error if there are other inputs as well.
bool is_scene_input(const std::vector<std::string>& inputs);

/// Returns the picture request of the file itself.
PictureRequest request_of(const SceneFile& file);
/// Throws Error naming the first option of the request that has no effect together with `own`, the request of a file.
void check_effect(const PictureRequest& asked, const PictureRequest& own);
/// Returns the view of the options, completed by that of a file without an eye.
ViewSettings view_of(const SceneCamera& own, const CameraOptions& camera, Look look);

/// Describes a scene: as JSON, and as lines of text.
nlohmann::ordered_json describe_scene(const std::string& path);
std::string scene_text_of(const nlohmann::ordered_json& info);

}  // namespace scarp::cli
