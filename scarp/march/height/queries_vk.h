// SPDX-License-Identifier: MIT
// Batch queries on a Vulkan device, for the marches that run there (device_march_names()).
//
//   rays, double ──▶ clipped, two floats per number ──▶ device, a slice at a time ──▶ answers ──▶ hits, double
//
// Results are in single precision. If a ray clears or hits the surface by more than the bound that doc/dev/numerics.md
// derives, its result agrees with the CPU's. Closest-hit and any-hit queries always agree.
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

struct ShaderProgram;  // vk/shader_program.h

/// Cost of one ray on the device.
struct DeviceRayCost {
  std::uint32_t steps = 0;    ///< visited blocks, cells or points
  std::uint32_t fetches = 0;  ///< samples and entries of the pyramid read
};

struct DeviceQuerySettings {
  bool statistics = false;               ///< whether costs are counted; if false, they are returned as zeros
  std::uint32_t rays_at_once = 1 << 18;  ///< size of a slice: rays on the device at once, 1 to 4,000,000
  int turns_at_once =
      60'000;  ///< maximum loop iterations per ray in one run, 1 to 60,000; longer marches continue in the next run
  bool exact_only = false;  ///< skips the lean first pass: slower; marches as shaders without buffers do
  /// Whether naive, fixed-step, relaxed and lipschitz over height fields end where a ray rises above the highest
  /// sample, as max-mip does. Points before that are the same. Hits beyond, above all ground but within a march's
  /// tolerance, are then lost.
  bool clip_at_top = false;
};

/// A height field on a device.
struct DeviceTarget {
  const HeightField* field = nullptr;
  const DeviceGround* ground = nullptr;  ///< made from the field
  /// slope_bound(*field), metres per metre; needed by marches with needs_slope.
  double slope = std::numeric_limits<double>::quiet_NaN();
  double seam = 0;  ///< as HeightTarget::seam, for max-mip
};

/// One march, ready to run on any ground of a device. Not thread-safe.
class DeviceQueries {
 public:
  /// Throws Error if the march does not run on devices (listing those that do), a setting is out of range, or the
  /// device lacks memory.
  explicit DeviceQueries(const Device& device, const HeightMarchEntry& march = find_height_march("max-mip"),
                         const MarchSettings& march_settings = {}, const DeviceQuerySettings& settings = {});
  DeviceQueries(DeviceQueries&&) noexcept;
  DeviceQueries& operator=(DeviceQueries&&) noexcept;
  ~DeviceQueries();

  /// Sets the march settings of later calls. Throws Error if a setting is out of range.
  void set_march_settings(const MarchSettings& march_settings);

  /// Sets hits[i] to the closest hit of rays[i], which must be valid (queries.h), and costs[i] to its cost unless
  /// `costs` is empty. Throws Error if spans differ in length, a required slope is missing, or the device is lost.
  void closest_hits(const DeviceTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                    std::span<DeviceRayCost> costs = {});
  /// Sets blocked[i] to 1 if closest_hits() would return a hit, else to 0.
  void occluded(const DeviceTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<DeviceRayCost> costs = {});

  /// Marches the rays of the last call once more, or its last slice; their answers stay on the device. For benchmarks:
  /// cards lower their clocks while the host prepares rays, so times are meaningful only after many runs in a row.
  void march_again();

  /// Returns the times of the last call's runs. A slice takes one run, or more if marches exceed turns_at_once.
  const std::vector<PassTime>& passes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Returns the names of the marches that run on devices, separated by commas.
std::string device_march_names();

/// The shaders of these marches, as queries without statistics specialise them.
std::vector<ShaderProgram> height_query_shaders();

}  // namespace scarp
