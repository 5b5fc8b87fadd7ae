// SPDX-License-Identifier: MIT
// Rays by the batch over terrain functions on a Vulkan device: queries_vk.h for functions, all marches of
// function_marches().
//
//   rays, double ──▶ clipped, two floats per number ──▶ device, a slice at a time ──▶ answers ──▶ hits, double
//
// Answers are those of single precision (doc/dev/numerics.md, "Functions in single precision"): `lipschitz-local` tells
// what the CPU tells wherever the ray passes or meets the ground by more than the bound that is derived there; it never
// passes a crossing, and neither does `lipschitz`. Closest and any always agree.
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

/// What is marched on a device.
struct DeviceFunctionTarget {
  const HeightFunction* function = nullptr;
  const DeviceFunction* device = nullptr;  ///< made of the function
  FunctionUse use = FunctionUse::march;
};

/// One march, ready to run over any function of a device. Used by one thread at a time.
class DeviceFunctionQueries {
 public:
  /// `march` is a row of function_marches(); of the settings `rays_at_once` counts. Throws Error: the march does not
  /// run on devices, a setting out of its range, no memory on the device.
  explicit DeviceFunctionQueries(const Device& device,
                                 const FunctionMarchEntry& march = find_function_march("lipschitz-local"),
                                 const MarchSettings& march_settings = {}, const DeviceQuerySettings& settings = {});
  DeviceFunctionQueries(DeviceFunctionQueries&&) noexcept;
  DeviceFunctionQueries& operator=(DeviceFunctionQueries&&) noexcept;
  ~DeviceFunctionQueries();

  /// For the calls that follow. Throws Error: a setting out of its range.
  void set_march_settings(const MarchSettings& march_settings);

  /// hits[i] answers rays[i], which must be valid (queries.h); steps[i], when not empty, is what that cost: bounds and
  /// heights. Throws Error when spans differ in length, or the device is lost.
  void closest_hits(const DeviceFunctionTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                    std::span<std::uint32_t> steps = {});
  /// blocked[i] is 1 where closest_hits would tell a hit, else 0.
  void occluded(const DeviceFunctionTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked);

  /// One for each slice of the last call.
  const std::vector<PassTime>& passes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scarp
