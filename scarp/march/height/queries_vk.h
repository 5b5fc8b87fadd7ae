// SPDX-License-Identifier: MIT
// Rays by the batch on a Vulkan device: queries.h for the marches that run there (HeightMarchEntry::gpu).
//
//   rays, double ──▶ clipped, two floats per number ──▶ device, a slice at a time ──▶ answers ──▶ hits, double
//
// Answers are those of single precision (doc/dev/numerics.md): the same as on the CPU wherever the ray passes or meets
// the surface by more than the bound that is derived there. Closest and any always agree.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scarp/accel/device_ground.h"
#include "scarp/march/height/height_table.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/device.h"

namespace scarp {

/// What a ray cost on the device.
struct DeviceRayCost {
  std::uint32_t steps = 0;    ///< blocks, cells or points looked at
  std::uint32_t fetches = 0;  ///< samples and entries of the pyramid read
};

struct DeviceQuerySettings {
  bool statistics = false;               ///< whether costs are counted; else they are told as zeros
  std::uint32_t rays_at_once = 1 << 18;  ///< a slice: what is on the device together, 1 to 4,000,000
  int turns_at_once =
      60'000;  ///< of a march's loop, then it goes on in the next run, so that runs are short: 1 to 60,000
};

/// What is marched on a device.
struct DeviceTarget {
  const HeightField* field = nullptr;
  const DeviceGround* ground = nullptr;  ///< made of the field
  /// slope_bound(*field), metres per metre; needed by marches with needs_slope.
  double slope = std::numeric_limits<double>::quiet_NaN();
};

/// One march, ready to run on any ground of a device. Used by one thread at a time.
class DeviceQueries {
 public:
  /// Throws Error: the march does not run on devices (which do), a setting out of its range, no memory on the device.
  explicit DeviceQueries(const Device& device, const HeightMarchEntry& march = find_height_march("max-mip"),
                         const MarchSettings& march_settings = {}, const DeviceQuerySettings& settings = {});
  DeviceQueries(DeviceQueries&&) noexcept;
  DeviceQueries& operator=(DeviceQueries&&) noexcept;
  ~DeviceQueries();

  /// For the calls that follow. Throws Error: a setting out of its range.
  void set_march_settings(const MarchSettings& march_settings);

  /// hits[i] answers rays[i], which must be valid (queries.h). costs, when not empty, is filled. Throws Error when
  /// spans differ in length, a slope is needed and not given, or the device is lost.
  void closest_hits(const DeviceTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                    std::span<DeviceRayCost> costs = {});
  /// blocked[i] is 1 where closest_hits would tell a hit, else 0.
  void occluded(const DeviceTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<DeviceRayCost> costs = {});

  /// One for each run of the last call: a slice takes one, and more where marches are longer than turns_at_once.
  const std::vector<PassTime>& passes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Names of the marches that run on devices, with commas between.
std::string device_march_names();

}  // namespace scarp
