// SPDX-License-Identifier: MIT
// Work for the device: recorded in order, run as one, each pass between two timestamps.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "scarp/vk/device.h"
#include "scarp/vk/memory.h"
#include "scarp/vk/pipeline.h"
#include "scarp/vk/raster.h"

namespace scarp {

/// One dispatch or drawing that has run.
struct PassTime {
  std::string name;                   ///< of its pipeline, of several the first
  std::optional<double> nanoseconds;  ///< nothing where the device has no timestamps
};

/// May be used again and again: record, run(), record, run(). Buffers and pipelines must live until run() returns.
class Commands {
 public:
  explicit Commands(const Device& device);
  Commands(Commands&&) noexcept;
  Commands& operator=(Commands&&) noexcept;
  /// Waits for what still runs.
  ~Commands();

  using Groups = std::array<std::uint32_t, 3>;
  /// `push` is the pipeline's push-constant block. `groups` counts workgroups, each at most 65535 (what every device
  /// allows). A pass sees what earlier ones of the same run have written only after a barrier().
  template <class Push>
  void dispatch(const ComputePipeline& pipeline, const Push& push, const Groups& groups) {
    static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= kMaxPushBytes);
    record_dispatch(pipeline, &push, sizeof push, groups);
  }
  /// One pass that draws into a target, which is cleared first: colours to 0, depths to `clear_depth` (0 is farthest).
  /// Calls are drawn in their order; there is at least one. Seen by later passes after a barrier().
  void draw(const RasterTarget& target, std::initializer_list<DrawCall> calls, float clear_depth = 0) {
    record_draw(target, {calls.begin(), calls.size()}, clear_depth);
  }
  /// Copies an image of a target that was drawn into in this run: colour 0, 1, ..., or, as the one after, depth. Rows
  /// from the top, 16 bytes (four floats) a pixel of colours, 4 of depths.
  void copy(const RasterTarget& from, std::uint32_t image, const DeviceBuffer& to);
  /// Writes one 32-bit word all over a part of a buffer; offset and size as for upload().
  void fill(const DeviceBuffer& buffer, std::uint64_t offset, std::uint64_t bytes, std::uint32_t word);
  /// What was recorded before is done, and its writes are seen, before what comes after begins.
  void barrier();

  /// Runs what was recorded and waits. Throws Error when the device is lost or has not finished within
  /// DeviceSettings::timeout_s.
  void run();
  /// The dispatches and drawings of the last run(), in order.
  const std::vector<PassTime>& passes() const;

 private:
  void record_dispatch(const ComputePipeline& pipeline, const void* push, std::uint32_t bytes, const Groups& groups);
  void record_draw(const RasterTarget& target, std::span<const DrawCall> calls, float clear_depth);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scarp
