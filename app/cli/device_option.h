// SPDX-License-Identifier: MIT
// --device: where the rays of a scene are answered.
#pragma once

#include <string>

#include "app/cli/command.h"
#include "scarp/scene/scene.h"

namespace scarp::cli {

void add_device_option(Command& command, std::string& device);

/// Checks before any file is read that rays of the march can be answered there; does nothing when `device` is empty.
/// Throws Error: the march does not run on devices, this program was built without Vulkan.
void require_device_march(const std::string& device, const HeightMarchEntry& march);

struct SceneOnDevice {
  Scene scene;
  std::string device;  ///< its name; empty: the CPU
};
/// The scene on the device; the scene itself when `device` is empty. Throws Error: there is no such device, it lacks
/// something, no memory, this program was built without Vulkan.
SceneOnDevice scene_on_device(const std::string& device, const Scene& scene);

}  // namespace scarp::cli
