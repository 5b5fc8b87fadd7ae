// SPDX-License-Identifier: MIT
// Rays by the batch against distance fields on a Vulkan device: queries_vk.h for shapes.
//
// Answers are those of single precision, by balls alone (sphere_trace.glsl.h): the CPU's wherever the ray passes or
// meets the surface by more than 4 times what values are off by (ShapeSingleRounding of accel/shape_words.h). Closest
// and any always agree. Grounds of height fields and functions may be among a shape's parts.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scarp/accel/device_function.h"
#include "scarp/accel/device_ground.h"
#include "scarp/accel/shape_words.h"
#include "scarp/march/height/queries_vk.h"
#include "scarp/march/shape/shape_table.h"
#include "scarp/vk/device.h"
#include "scarp/vk/memory.h"

namespace scarp {

/// A distance field in the memory of a device.
class DeviceShape {
 public:
  /// Throws Error: no memory for it, a function in it whose numbers do not fit into floats, or too many instructions.
  DeviceShape(const Device& device, const DistanceField& shape);

  std::uint64_t code() const { return code_.address(); }
  std::uint64_t numbers() const { return numbers_.address(); }
  std::uint64_t grounds() const { return grounds_.address(); }
  const ShapeSingleRounding& rounding() const { return rounding_; }
  /// Turns of loops that a value takes, at most.
  std::size_t turns() const { return turns_; }

 private:
  DeviceShape(const Device& device, const DistanceField& shape, const ShapeWords& words);

  ShapeSingleRounding rounding_;
  DeviceBuffer code_, numbers_, grounds_;
  std::vector<DeviceFunction> functions_;
  std::vector<DeviceGround> fields_;  // those of holes, too
  std::size_t turns_;
};

/// What is marched on a device.
struct DeviceShapeTarget {
  const DistanceField* shape = nullptr;
  const DeviceShape* device = nullptr;  ///< made of the shape
};

/// One march, ready to run against any shape of a device. Used by one thread at a time.
class DeviceShapeQueries {
 public:
  /// `march` is a row of shape_marches(). Throws Error: the march does not run on devices, a setting out of its
  /// range, no memory on the device.
  explicit DeviceShapeQueries(const Device& device, const ShapeMarchEntry& march = find_shape_march("sphere-trace"),
                              const MarchSettings& march_settings = {}, const DeviceQuerySettings& settings = {});
  DeviceShapeQueries(DeviceShapeQueries&&) noexcept;
  DeviceShapeQueries& operator=(DeviceShapeQueries&&) noexcept;
  ~DeviceShapeQueries();

  /// For the calls that follow. Throws Error: a setting out of its range.
  void set_march_settings(const MarchSettings& march_settings);

  /// hits[i] answers rays[i], which must be valid (queries.h); steps[i], when not empty, is how many values that took.
  /// Throws Error when spans differ in length, or the device is lost.
  void closest_hits(const DeviceShapeTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                    std::span<std::uint32_t> steps = {});
  /// blocked[i] is 1 where closest_hits would tell a hit, else 0.
  void occluded(const DeviceShapeTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scarp
