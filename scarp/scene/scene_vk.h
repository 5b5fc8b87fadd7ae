// SPDX-License-Identifier: MIT
// Scenes on a Vulkan device:
//
//   const Device device({.choice = "gpu"});
//   const Scene scene = scene_on(device, Scene(scene_heights(std::move(field), march, settings,
//   AnsweredBy::back_end)));
//
// The device answers each field's rays in single precision; placements and the hierarchy stay on the CPU. Heights,
// functions and shapes run there; the CPU answers rays over other fields.
#pragma once

#include <memory>

#include "scarp/accel/device_ground.h"
#include "scarp/scene/scene.h"
#include "scarp/vk/device.h"

namespace scarp {

/// Copies the fields that run there into the device's memory. Throws Error naming the field: none runs there, a march
/// that does not, no memory for it. Queries throw Error when the device is lost. Answers are those of march/height/
/// queries_vk.h, march/function/function_queries_vk.h and march/shape/shape_queries_vk.h.
Scene scene_on(const Device& device, const Scene& scene);

/// What a device holds of a scene of one height field at the origin: Scene::device_terrain().
struct DeviceTerrain {
  Device device;
  const DeviceGround& ground;
  const MarchSettings& settings;
  mutable std::shared_ptr<void> kept{};  ///< what was made for pictures of it, by the station that makes them
};

}  // namespace scarp
