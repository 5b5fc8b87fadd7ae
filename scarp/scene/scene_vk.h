// SPDX-License-Identifier: MIT
// Scenes on a Vulkan device:
//
//   const Device device({.choice = "gpu"});
//   const Scene on_device = scene_on(device, terrain);
//   cast(on_device, rays, hits);
//
// The device traces the rays of each field in single precision; placements and the hierarchy stay on the CPU. Height
// fields, functions and shapes run on the device, other fields on the CPU.
#pragma once

#include <memory>

#include "scarp/accel/device_ground.h"
#include "scarp/scene/scene.h"
#include "scarp/vk/device.h"

namespace scarp {

/// Copies the fields that run on the device into its memory; later edits do not reach it. Throws Error naming the
/// field: none that runs there, a march that does not, too little memory. Queries throw Error if the device is lost.
/// Results are those of march/height/queries_vk.h, march/function/function_queries_vk.h and
/// march/shape/shape_queries_vk.h.
///
/// A field made by scene_heights() with AnsweredBy::back_end builds nothing for the CPU.
Scene scene_on(const Device& device, const Scene& scene);

/// The height field of a scene of one at the origin, on its device: Scene::device_terrain().
struct DeviceTerrain {
  Device device;
  const DeviceGround& ground;
  const MarchSettings& settings;
  mutable std::shared_ptr<void> kept{};  ///< cache of the station that renders pictures
};

}  // namespace scarp
