// SPDX-License-Identifier: MIT
// Scenes of many fields on a Vulkan device.
//
//   const Scene scene = scene_on(Device({.choice = "gpu"}), read_scene("scene.json").scene);
//   scene.closest_hits(rays, hits);
//
// Which objects a ray may meet the CPU finds, by the hierarchy of boxes; what it meets there the device, one call per
// field. Normals and materials stay with the fields, in double.
#pragma once

#include "scarp/scene/scene.h"
#include "scarp/vk/device.h"

namespace scarp {

/// Puts the scene's fields into the device's memory; their marches answer there, in single precision. Throws Error: a
/// field that does not run on devices (which, and what to do), a setting out of its range, no memory on the device.
/// Questions throw Error when the device is lost.
Scene scene_on(const Device& device, const Scene& scene);

}  // namespace scarp
