// SPDX-License-Identifier: MIT
// Batches of rays over terrain functions on a Vulkan device: queries_vk.h for functions, all marches of
// function_marches().
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
  /// `march` is a row of function_marches(); of the settings only `rays_at_once` applies. Throws Error if the march
  /// does not run on devices, a setting is out of range, or the device lacks memory.
  explicit DeviceFunctionQueries(const Device& device,
                                 const FunctionMarchEntry& march = find_function_march("lipschitz-local"),
                                 const MarchSettings& march_settings = {}, const DeviceQuerySettings& settings = {});
  DeviceFunctionQueries(DeviceFunctionQueries&&) noexcept;
  DeviceFunctionQueries& operator=(DeviceFunctionQueries&&) noexcept;
  ~DeviceFunctionQueries();

  /// Applies to later calls. Throws Error for a setting out of range.
  void set_march_settings(const MarchSettings& march_settings);

  /// hits[i] answers rays[i], which must be valid (queries.h); steps[i], unless empty, is its cost: bounds and heights.
  /// Throws Error if spans differ in length, or the device is lost.
  void closest_hits(const DeviceFunctionTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                    std::span<std::uint32_t> steps = {});
  /// blocked[i] is 1 if closest_hits would report a hit, otherwise 0.
  void occluded(const DeviceFunctionTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked);

  /// One for each slice of the last call.
  const std::vector<PassTime>& passes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The shaders of these marches, as specialised for a fractal and for a function of all operations.
std::vector<ShaderProgram> function_query_shaders();

}  // namespace scarp
