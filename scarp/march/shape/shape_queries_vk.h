// SPDX-License-Identifier: MIT
// Batches of rays against distance fields on a Vulkan device: the counterpart of queries_vk.h for shapes.
//
// Answers are in single precision, using ball bounds only (sphere_trace.glsl.h): equal to the CPU's wherever the ray
// misses or hits the surface by more than 4 times the error of values (ShapeSingleRounding of accel/shape_words.h).
// Closest hit and any hit always agree. Shapes may contain grounds of height fields and functions.
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

/// A distance field in device memory.
class DeviceShape {
 public:
  /// Throws Error if the device lacks memory, a constant of a function does not fit in single precision, or there are
  /// too many instructions.
  DeviceShape(const Device& device, const DistanceField& shape);

  std::uint64_t code() const { return code_.address(); }
  std::uint64_t numbers() const { return numbers_.address(); }
  std::uint64_t grounds() const { return grounds_.address(); }
  const ShapeSingleRounding& rounding() const { return rounding_; }
  /// Maximum loop iterations per value.
  std::size_t turns() const { return turns_; }

 private:
  DeviceShape(const Device& device, const DistanceField& shape, const ShapeWords& words);

  ShapeSingleRounding rounding_;
  DeviceBuffer code_, numbers_, grounds_;
  std::vector<DeviceFunction> functions_;
  std::vector<DeviceGround> fields_;  // including those that define holes
  std::size_t turns_;
};

/// A shape on a device.
struct DeviceShapeTarget {
  const DistanceField* shape = nullptr;
  const DeviceShape* device = nullptr;  ///< made from the shape
};

/// One march, ready to run against any shape of a device. Not thread-safe.
class DeviceShapeQueries {
 public:
  /// `march` is a row of shape_marches(). Throws Error if the march does not run on devices, a setting is out of range,
  /// or the device lacks memory.
  explicit DeviceShapeQueries(const Device& device, const ShapeMarchEntry& march = find_shape_march("sphere-trace"),
                              const MarchSettings& march_settings = {}, const DeviceQuerySettings& settings = {});
  DeviceShapeQueries(DeviceShapeQueries&&) noexcept;
  DeviceShapeQueries& operator=(DeviceShapeQueries&&) noexcept;
  ~DeviceShapeQueries();

  /// Sets the march settings of later calls. Throws Error if a setting is out of range.
  void set_march_settings(const MarchSettings& march_settings);

  /// Sets hits[i] to the closest hit of rays[i], which must be valid (queries.h), and steps[i], unless `steps` is
  /// empty, to its number of values. Throws Error if spans differ in length, or the device is lost.
  void closest_hits(const DeviceShapeTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                    std::span<std::uint32_t> steps = {});
  /// Sets blocked[i] to 1 if closest_hits() would return a hit, else to 0.
  void occluded(const DeviceShapeTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The shader of this march, as specialised for a sphere, for a solid with all operations, and with grounds.
std::vector<ShaderProgram> shape_query_shaders();

}  // namespace scarp
