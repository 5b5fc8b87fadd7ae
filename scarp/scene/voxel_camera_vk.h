// SPDX-License-Identifier: MIT
// Traces a camera's rays against voxels on a Vulkan device, with either method of drawing (VoxelDrawing):
//
//   VoxelCamera camera(device, scene);                                   // a scene of one field, of voxels
//   camera.look(VoxelDrawing::proxies, picture, rays, hits);             // a ray per pixel
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "scarp/march/voxel/voxel_drawing.h"
#include "scarp/scene/scene.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/device.h"

namespace scarp {

/// Voxels of a scene on a device. Not thread-safe.
class VoxelCamera {
 public:
  /// Copies the voxels; later edits do not reach them. Throws Error unless the scene is one field of voxels, not
  /// rounded, at the origin, whose marches run on devices; or if the device lacks memory, graphics or 64-bit floating
  /// point numbers.
  VoxelCamera(const Device& device, const Scene& scene, const DeviceVoxelSettings& settings = {});
  VoxelCamera(VoxelCamera&&) noexcept;
  VoxelCamera& operator=(VoxelCamera&&) noexcept;
  ~VoxelCamera();

  /// Sets hits[i] to Scene::closest_hit(rays[i]), bit for bit. rays[i] is the ray of pixel i, row by row, within
  /// half a pixel of its middle.
  void look(VoxelDrawing way, const VoxelPicture& picture, std::span<const Ray> rays, std::span<Hit> hits,
            std::span<std::uint32_t> steps = {});

  /// Returns the times of the last picture's passes.
  const std::vector<PassTime>& passes() const;
  /// Number of pixels of the last picture by proxies that the compute shader traced.
  std::size_t tied() const;
  /// Size on the device: the grids with their accelerators; the objects and the hierarchy; pictures.
  struct Bytes {
    std::uint64_t grids = 0, objects = 0, pictures = 0;
  };
  Bytes bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scarp
