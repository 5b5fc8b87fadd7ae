// SPDX-License-Identifier: MIT
// Pictures of voxel objects on a Vulkan device: a ray per pixel, answered in one of two ways.
//
//   compute   a hierarchy over the boxes of the objects is walked in the shader (voxel_queries_vk.h)
//   proxies   each object's box is drawn as triangles, and its fragments march (C. Leak, "Raymarching voxel
//             rendering", 2017)
//
// Both return the hits of the CPU, bit for bit. Proxies are exact because:
//
//   the ray of a pixel is the one of compute, not an interpolated one   voxel_proxies_march.glsl.h
//   boxes are drawn a little larger; a camera in a box draws all sides of it   voxel_proxies.vert
//   the depth of the hit is written, not that of the box; as the hit is behind the nearest corner of the box, fragments
//   behind what is there already need not march (depth_less)
//   where two objects may have hits of the same depth, compute answers the ray   voxel_proxies.comp
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "scarp/march/voxel/voxel_queries_vk.h"

namespace scarp {

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

/// Draws voxel objects of a device. Not thread-safe.
class DeviceVoxelPictures {
 public:
  /// `queries` computes the pixels that drawing leaves open. Throws Error if the device does not support graphics, or
  /// lacks memory or 64-bit floating point numbers.
  DeviceVoxelPictures(const Device& device, std::shared_ptr<DeviceVoxelQueries> queries, bool words = false);
  DeviceVoxelPictures(DeviceVoxelPictures&&) noexcept;
  DeviceVoxelPictures& operator=(DeviceVoxelPictures&&) noexcept;
  ~DeviceVoxelPictures();

  /// Sets hits[i] to the closest hit of rays[i], the ray of pixel i, row by row: within half a pixel of its middle, and
  /// with t no less than in the form of VoxelPicture. Returns the indices of rays without an answer, as
  /// DeviceVoxelQueries does. Throws Error if spans differ in length, or the picture is too large for the device, or
  /// its rays do not span space; or if the device is lost. details.steps are those in the objects that are hit.
  std::vector<std::size_t> draw(const DeviceVoxelObjects& objects, const VoxelPicture& picture,
                                std::span<const Ray> rays, std::span<Hit> hits, const DeviceVoxelDetails& details = {});

  /// Pixels of the last picture that compute answered, because objects may have been at the same depth.
  std::size_t tied() const;
  /// Returns the times of the last picture: the boxes, their hits, and the pixels that compute answered.
  const std::vector<PassTime>& passes() const;
  /// Size on the device, of the largest picture so far.
  std::uint64_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The shaders of proxies.
std::vector<ShaderProgram> voxel_picture_shaders();

}  // namespace scarp
