// SPDX-License-Identifier: MIT
// Batches of rays over terrain functions on a Vulkan device: the counterpart of queries_vk.h for functions, with all
// marches of function_marches().
//
//   rays, double ──▶ clipped, two floats per number ──▶ device, a slice at a time ──▶ answers ──▶ hits, double
//
// Answers are in single precision (doc/dev/numerics.md, "Functions in single precision"): `lipschitz-local` agrees with
// the CPU wherever the ray misses or hits the ground by more than the bound derived there. It misses no crossing, and
// neither does `lipschitz`. Closest hit and any hit always agree.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scarp/accel/device_function.h"
#include "scarp/march/function/function_table.h"
#include "scarp/march/height/queries_vk.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/device.h"

namespace scarp {

/// A function on a device.
struct DeviceFunctionTarget {
  const HeightFunction* function = nullptr;
  const DeviceFunction* device = nullptr;  ///< made from the function
  FunctionUse use = FunctionUse::march;
};

/// One march, ready to run over any function of a device. Not thread-safe.
class DeviceFunctionQueries {
 public:
  /// `march` is a row of function_marches(); `rays_at_once` is the only setting that applies. Throws Error if the march
  /// does not run on devices, a setting is out of range, or the device lacks memory.
  explicit DeviceFunctionQueries(const Device& device,
                                 const FunctionMarchEntry& march = find_function_march("lipschitz-local"),
                                 const MarchSettings& march_settings = {}, const DeviceQuerySettings& settings = {});
  DeviceFunctionQueries(DeviceFunctionQueries&&) noexcept;
  DeviceFunctionQueries& operator=(DeviceFunctionQueries&&) noexcept;
  ~DeviceFunctionQueries();

  /// Sets the march settings of later calls. Throws Error if a setting is out of range.
  void set_march_settings(const MarchSettings& march_settings);

  /// Sets hits[i] to the closest hit of rays[i], which must be valid (queries.h), and steps[i], unless `steps` is
  /// empty, to its cost: the number of bounds and heights. Throws Error if spans differ in length, or the device is
  /// lost.
  void closest_hits(const DeviceFunctionTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                    std::span<std::uint32_t> steps = {});
  /// Sets blocked[i] to 1 if closest_hits() would return a hit, else to 0.
  void occluded(const DeviceFunctionTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked);

  /// Returns the times of the last call, one per slice.
  const std::vector<PassTime>& passes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The shaders of these marches, as specialised for a fractal and for a function with all operations.
std::vector<ShaderProgram> function_query_shaders();

}  // namespace scarp
