// SPDX-License-Identifier: MIT
// --device: the device that traces the rays of a scene; --voxel-drawing: the method for camera rays over voxels.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "app/options/command.h"
#include "scarp/render/camera/camera.h"
#include "scarp/scene/scene.h"

namespace scarp::cli {

void add_device_option(Command& command, std::string& device);
/// Call after add_device_option(). `drawing` is a name in kVoxelDrawings.
void add_voxel_drawing_option(Command& command, std::string& drawing, const std::string& device);

/// Checks, before any file is read, that the march runs on the device; does nothing if `device` is empty. Throws Error
/// if the march does not run on devices, or this program was built without Vulkan.
void require_device_march(const std::string& device, const HeightMarchEntry& march);

struct DeviceSight;

struct SceneOnDevice {
  Scene scene;
  std::string device;  ///< its name; empty: the CPU
  std::shared_ptr<DeviceSight> sight{};
};
/// Returns the scene on the device; the scene itself if `device` is empty. Throws Error if the device does not exist or
/// lacks a feature or memory, or if this program was built without Vulkan.
SceneOnDevice scene_on_device(const std::string& device, const Scene& scene, const std::string& drawing = "compute");

/// Sets the camera of the next picture on the device, with aa x aa samples per pixel; does nothing on the CPU.
void look_through(const SceneOnDevice& there, const Camera& camera, int aa);
/// "2,304 rays by drawing": rays drawn so far; empty if drawing is not used.
std::string drawn_by(const SceneOnDevice& there);

}  // namespace scarp::cli
