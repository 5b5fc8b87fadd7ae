// SPDX-License-Identifier: MIT
// Terrain scenes on a Vulkan device.
//
//   const TerrainScene scene = terrain_scene_on(Device({.choice = "gpu"}), std::move(field));
//   render_picture(scene, camera, grid_north_azimuth, settings);
#pragma once

#include <optional>

#include "scarp/accel/device_ground.h"
#include "scarp/scene/terrain_scene.h"
#include "scarp/vk/device.h"

namespace scarp {

/// Samples and pyramid are put into the device's memory, and its marches answer all rays, in single precision
/// (march/queries_vk.h). Throws Error: the march does not run on devices, a setting is out of its range, no memory on
/// the device. Questions throw Error when the device is lost.
TerrainScene terrain_scene_on(const Device& device, HeightField field, const MarchEntry& march = find_march("max-mip"),
                              const MarchSettings& settings = {});

/// Where the ground of such a scene is, for what draws beside it. Lives as long as the scene and its copies do.
struct DeviceTerrain {
  const Device& device;
  const DeviceGround& ground;
};
/// Nothing when another answers the scene's rays.
std::optional<DeviceTerrain> device_terrain(const TerrainScene& scene);

}  // namespace scarp
