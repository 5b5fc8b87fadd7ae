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
#include "scarp/march/voxel/voxel_drawing.h"
#include "scarp/scene/scene.h"
#include "scarp/vk/device.h"

namespace scarp {

/// Returns the same scene, traced on a device. Copies the fields that run on the device into its memory; later edits do
/// not reach it. Throws Error naming the field if no field runs on the device, if a march does not, or if the device
/// lacks memory. Queries throw Error if the device is lost. march/height/queries_vk.h,
/// march/function/function_queries_vk.h and march/shape/shape_queries_vk.h document the accuracy of results.
///
/// Fields made by scene_heights() with AnsweredBy::back_end build no acceleration structure for the CPU.
///
/// `sight`: how voxels are drawn (march/voxel/voxel_drawing.h); null: by compute shaders.
Scene scene_on(const Device& device, const Scene& scene, std::shared_ptr<VoxelSight> sight = nullptr);

/// A height field on its device, returned by Scene::device_terrain().
struct DeviceTerrain {
  Device device;
  const DeviceGround& ground;
  const MarchSettings& settings;
  mutable std::shared_ptr<void> kept{};  ///< cache of the render station
};

}  // namespace scarp
