// SPDX-License-Identifier: MIT
// Batches of rays against voxel grids on a Vulkan device: the counterpart of queries_vk.h for voxels.
//
//   rays, double ──▶ device: hierarchy over tight bounds ──▶ quantised per object ──▶ integers ──▶ hits, double
//
// Answers are those of the CPU, bit for bit: voxel, face, t, object, entry. The device must support 64-bit floating
// point numbers, in which rays are quantised. Rays that it cannot trace exactly are left to the caller: those with
// numbers outside 2^-200 to 2^200 in magnitude, and those that exceed 60,000 boxes and steps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scarp/accel/device_voxels.h"
#include "scarp/base/ray.h"
#include "scarp/march/voxel/voxel_drawing.h"
#include "scarp/march/voxel/voxel_table.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/device.h"
#include "scarp/vk/memory.h"
#include "scarp/vk/shader_program.h"

namespace scarp {

/// Nodes over the boxes of objects, as scene/box_tree.h makes them.
struct DeviceBoxes {
  std::span<const glsl::ScarpBoxNode> nodes;
  dvec3 middle{0.0};          ///< nodes are relative to it
  dvec3 low{0.0}, high{0.0};  ///< the padded box around everything
  std::uint32_t levels = 1;   ///< of the hierarchy, at most kMaxLevels
  static constexpr std::uint32_t kMaxLevels = 64;
};

/// Placed grids on a device. The grids must outlive them.
class DeviceVoxelObjects {
 public:
  /// Throws Error naming the object if its numbers are outside 2^-200 to 2^200 in magnitude, or if the device lacks
  /// memory or 64-bit floating point numbers.
  DeviceVoxelObjects(const Device& device, const DeviceVoxels& grids, std::span<const glsl::ScarpVoxelObject> objects,
                     std::span<const glsl::ScarpVoxelTurn> turns, const DeviceBoxes& boxes);
  /// One grid at the origin, as part 0.
  DeviceVoxelObjects(const Device& device, const DeviceVoxels& grids, std::uint32_t grid);

  std::uint64_t address() const { return header_.address(); }
  /// Returns the march that all grids use, or kScarpVoxelMarches if they use several.
  std::uint32_t march() const { return march_; }
  /// Returns the levels of the hierarchy.
  std::uint32_t levels() const { return levels_; }
  std::uint32_t count() const { return count_; }
  /// Returns the largest side of a voxel of all objects, in metres.
  double voxel_side() const { return voxel_side_; }
  std::uint64_t bytes() const { return objects_.bytes() + turns_.bytes() + nodes_.bytes() + header_.bytes(); }

 private:
  std::uint32_t march_, levels_, count_;
  double voxel_side_ = 0;
  DeviceBuffer objects_, turns_, nodes_, header_;
};

/// More results per ray; empty spans are not filled.
struct DeviceVoxelDetails {
  std::span<std::uint32_t> steps{};    ///< of the ray's marches
  std::span<std::uint32_t> entries{};  ///< VoxelGrid::entry() of hits
};

/// Voxel marches, ready to run on any objects of a device. Not thread-safe.
class DeviceVoxelQueries {
 public:
  /// Throws Error if the device lacks memory or 64-bit floating point numbers.
  explicit DeviceVoxelQueries(const Device& device, const DeviceVoxelSettings& settings = {});
  DeviceVoxelQueries(DeviceVoxelQueries&&) noexcept;
  DeviceVoxelQueries& operator=(DeviceVoxelQueries&&) noexcept;
  ~DeviceVoxelQueries();

  /// Sets hits[i] to the closest hit of rays[i], which starts next to the voxel of from[i] unless that is null or
  /// `from` is empty. Returns the indices of rays without an answer. Throws Error if spans differ in length or the
  /// device is lost.
  std::vector<std::size_t> closest_hits(const DeviceVoxelObjects& objects, std::span<const Ray> rays,
                                        std::span<const Hit* const> from, std::span<Hit> hits,
                                        const DeviceVoxelDetails& details = {});
  /// Sets blocked[i] to 1 if closest_hits() would return a hit, else to 0. Returns as it does.
  std::vector<std::size_t> occluded(const DeviceVoxelObjects& objects, std::span<const Ray> rays,
                                    std::span<const Hit* const> from, std::span<std::uint8_t> blocked);

  /// Returns the times of the last call's runs, one per slice.
  const std::vector<PassTime>& passes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The shaders of these marches.
std::vector<ShaderProgram> voxel_query_shaders();

}  // namespace scarp
