// SPDX-License-Identifier: MIT
// Terrain scenes on a Vulkan device.
//
//   const TerrainScene scene = terrain_scene_on(Device({.choice = "gpu"}), std::move(field));
//   render_picture(scene, camera, grid_north_azimuth, settings);
#pragma once

#include <memory>

#include "scarp/accel/device_ground.h"
#include "scarp/scene/terrain_scene.h"
#include "scarp/vk/device.h"

namespace scarp {

/// Samples and pyramid are put into the device's memory, and its marches answer all rays, in single precision
/// (march/height/queries_vk.h). Throws Error: the march does not run on devices, a setting is out of its range, no
/// memory on the device. Questions throw Error when the device is lost.
TerrainScene terrain_scene_on(const Device& device, HeightField field,
                              const HeightMarchEntry& march = find_height_march("max-mip"),
                              const MarchSettings& settings = {});

/// What a device holds of a terrain scene.
struct DeviceTerrain {
  Device device;
  const DeviceGround& ground;
  const MarchSettings& settings;
  mutable std::shared_ptr<void> kept{};  ///< what was made for pictures of it, by the station that makes them
};

}  // namespace scarp
