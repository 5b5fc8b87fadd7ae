// SPDX-License-Identifier: MIT
// Private to the station: voxels of a scene on a Vulkan device.
#pragma once

#include <memory>

#include "scarp/accel/device_voxels.h"
#include "scarp/march/voxel/voxel_drawing.h"
#include "scarp/march/voxel/voxel_queries_vk.h"
#include "scarp/scene/field_on_device.h"
#include "scarp/scene/scene_field.h"

namespace scarp {

/// Models, and the objects that place them.
struct ObjectsOnDevice {
  /// Throws Error for a march that does not run on devices, or if the device lacks memory or 64-bit floating point
  /// numbers.
  ObjectsOnDevice(const Device& device, const VoxelObjects& voxels);

  DeviceVoxels grids;
  DeviceVoxelObjects objects;
};

/// `sight` may be null. Returns null for rounded voxels, which the CPU traces. Throws Error for a march that does not
/// run on devices, or if the device lacks memory or 64-bit floating point numbers.
std::unique_ptr<FieldOnDevice> voxels_on_device(const Device& device,
                                                const std::shared_ptr<DeviceVoxelQueries>& queries,
                                                const std::shared_ptr<VoxelSight>& sight, const SceneField& field,
                                                const SceneFieldParts::Voxels& parts);

}  // namespace scarp
