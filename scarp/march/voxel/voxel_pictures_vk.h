// SPDX-License-Identifier: MIT
// Pictures of voxel objects on a Vulkan device: a ray per pixel, answered in one of two ways.
//
//   compute   a hierarchy over the boxes of the objects is walked in the shader (voxel_queries_vk.h)
//   proxies   each object's box is drawn as triangles, and its fragments march (C. Leak, "Raymarching voxel
//             rendering", 2017)
//
// Both return the hits of the CPU, bit for bit. Proxies are exact because:
//
//   the ray of a pixel is that of compute, not an interpolated one   voxel_proxies_march.glsl.h
//   boxes are drawn a little larger; a camera in a box draws all sides of it   voxel_proxies.vert
//   the depth of the hit is written, not that of the box; as the hit is behind the nearest corner of the box, fragments
//   behind what is there already need not march (depth_less)
//   where two objects may have hits of the same depth, compute answers the ray   voxel_proxies.comp
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scarp/march/voxel/voxel_drawing.h"
#include "scarp/march/voxel/voxel_queries_vk.h"

namespace scarp {

/// Draws voxel objects of a device. Not thread-safe.
class DeviceVoxelPictures {
 public:
  /// `queries` computes the pixels that drawing leaves open. Throws Error if the device does not support graphics, or
  /// lacks memory or 64-bit floating point numbers.
  DeviceVoxelPictures(const Device& device, std::shared_ptr<DeviceVoxelQueries> queries, bool words = false);
  DeviceVoxelPictures(DeviceVoxelPictures&&) noexcept;
  DeviceVoxelPictures& operator=(DeviceVoxelPictures&&) noexcept;
  ~DeviceVoxelPictures();

  /// Sets hits[i] to the closest hit of rays[i], the ray of pixel i, row by row: within half a pixel of its centre, and
  /// with t no less than in the form of VoxelPicture. Returns the indices of rays without an answer, as
  /// DeviceVoxelQueries does. Throws Error if spans differ in length, the picture is too large for the device, its rays
  /// do not span space, or the device is lost. details.steps are those in the objects that are hit.
  std::vector<std::size_t> draw(const DeviceVoxelObjects& objects, const VoxelPicture& picture,
                                std::span<const Ray> rays, std::span<Hit> hits, const DeviceVoxelDetails& details = {});

  /// Returns the number of pixels of the last picture that compute answered, because objects may have been at the same
  /// depth.
  std::size_t tied() const;
  /// Returns the times of the last picture: the boxes, their hits, and the pixels that compute answered.
  const std::vector<PassTime>& passes() const;
  /// Returns the size in device memory of the largest picture so far, in bytes.
  std::uint64_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The shaders of proxies.
std::vector<ShaderProgram> voxel_picture_shaders();

}  // namespace scarp
