// SPDX-License-Identifier: MIT
// --device: where the rays of a scene are answered.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "scarp/scene/scene.h"
#include "scarp/scene/terrain_scene.h"

namespace scarp::cli {

void add_device_option(CLI::App& command, std::string& device);

struct SceneMaker {
  std::function<TerrainScene(HeightField field, const HeightMarchEntry& march, const MarchSettings& settings)> make;
  std::string device;  ///< its name; empty: the marches of the CPU
};

/// Opens the device, so that what is wrong with the choice is known before a file is read. Throws Error: there is no
/// such device, it lacks something, the march does not run on devices, this program was built without Vulkan.
SceneMaker scene_maker(const std::string& device, const HeightMarchEntry& march);

struct SceneOnDevice {
  Scene scene;
  std::string device;  ///< its name; empty: the CPU
};
/// A scene of many fields there; the scene itself when `device` is empty. Throws Error likewise.
SceneOnDevice scene_on_device(const std::string& device, const Scene& scene);

}  // namespace scarp::cli
