// SPDX-License-Identifier: MIT
// How voxels are drawn on a Vulkan device, and the rays of a picture's pixels. To pass the current camera to a scene on
// a device whose voxels are drawn (VoxelDrawing::proxies):
//
//   const auto sight = std::make_shared<VoxelSight>(VoxelSight{VoxelDrawing::proxies});
//   const Scene there = scene_on(device, scene, sight);
//   sight->picture = ...;                               // before each picture
//
// In batches of free rays, the camera's rays are then traced by drawing boxes, all others by compute, with the same
// results. A ray is the camera's if it starts there and has a pixel that no other ray of the batch has.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "scarp/base/vec.h"

namespace scarp {

/// Settings of voxel marches on a device.
struct DeviceVoxelSettings {
  std::uint32_t rays_at_once = 1 << 18;  ///< size of a slice: rays on the device at once, 1 to 4,000,000
  bool words = false;                    ///< two 32-bit words instead of 64-bit integers, for tests
};

enum class VoxelDrawing : std::uint8_t { compute, proxies };

struct VoxelDrawingName {
  std::string_view name;
  VoxelDrawing drawing;
  std::string_view what;
};
/// Both methods, the default first.
inline constexpr std::array<VoxelDrawingName, 2> kVoxelDrawings = {{
    {"compute", VoxelDrawing::compute, "a hierarchy of boxes in a compute shader"},
    {"proxies", VoxelDrawing::proxies, "boxes drawn as triangles whose fragments march"},
}};

/// The rays of a picture's pixels. The position (x, y), in pixels from the upper left corner, has the rays
///
///   origin + x origin_right + y origin_down + t (direction + x right + y down)
///
/// in perspective without origin_right and origin_down, else without right and down.
struct VoxelPicture {
  std::uint32_t width = 1, height = 1;
  dvec3 origin{0.0}, origin_right{0.0}, origin_down{0.0};
  dvec3 direction{0, 0, -1}, right{0.0}, down{0.0};

  bool parallel() const { return origin_right != dvec3(0.0) || origin_down != dvec3(0.0); }
};

/// The camera of a scene on a device, for scene_on().
struct VoxelSight {
  VoxelDrawing drawing = VoxelDrawing::compute;
  VoxelPicture picture{};   ///< a pixel per sample
  std::uint64_t drawn = 0;  ///< number of rays traced by drawing so far
};

}  // namespace scarp
