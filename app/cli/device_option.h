// SPDX-License-Identifier: MIT
// --device: where the rays of a scene are answered; --voxel-drawing: how those of a camera are, over voxels.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "app/cli/command.h"
#include "scarp/render/camera/camera.h"
#include "scarp/scene/scene.h"

namespace scarp::cli {

void add_device_option(Command& command, std::string& device);
/// After add_device_option(). `drawing` is a name of kVoxelDrawings.
void add_voxel_drawing_option(Command& command, std::string& drawing, const std::string& device);

/// Checks before any file is read that rays of the march can be answered there; does nothing when `device` is empty.
/// Throws Error: the march does not run on devices, this program was built without Vulkan.
void require_device_march(const std::string& device, const HeightMarchEntry& march);

struct DeviceSight;

struct SceneOnDevice {
  Scene scene;
  std::string device;  ///< its name; empty: the CPU
  std::shared_ptr<DeviceSight> sight{};
};
/// The scene on the device; the scene itself when `device` is empty. Throws Error: there is no such device, it lacks
/// something, no memory, this program was built without Vulkan.
SceneOnDevice scene_on_device(const std::string& device, const Scene& scene, const std::string& drawing = "compute");

/// Tells the device the camera of the next picture, of aa x aa samples per pixel; does nothing on the CPU.
void look_through(const SceneOnDevice& there, const Camera& camera, int aa);
/// "2,304 rays by drawing": what it drew of the pictures so far; empty if nothing was to be drawn.
std::string drawn_by(const SceneOnDevice& there);

}  // namespace scarp::cli
