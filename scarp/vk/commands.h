// SPDX-License-Identifier: MIT
// Command recording: dispatches and draws that run in order, each between two timestamps.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "scarp/vk/device.h"
#include "scarp/vk/memory.h"
#include "scarp/vk/pipeline.h"

namespace scarp {

class RasterTarget;  // raster.h
struct DrawCall;

/// Timing of one dispatch or draw.
struct PassTime {
  std::string name;                   ///< name of its pipeline (of the first, if several)
  std::optional<double> nanoseconds;  ///< empty if the device has no timestamps
};

/// A reusable command list: record, run(), record, run(). Buffers and pipelines must live until run() returns.
class Commands {
 public:
  explicit Commands(const Device& device);
  Commands(Commands&&) noexcept;
  Commands& operator=(Commands&&) noexcept;
  /// Waits for a run that has not finished; at most a few seconds on a device that was given up.
  ~Commands();

  using Groups = std::array<std::uint32_t, 3>;
  /// `push` is the pipeline's push-constant block. `groups` counts workgroups, each at most 65535 (the limit that every
  /// device supports). A pass sees the writes of earlier passes of the same run only after a barrier().
  template <class Push>
  void dispatch(const ComputePipeline& pipeline, const Push& push, const Groups& groups) {
    static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= kMaxPushBytes);
    record_dispatch(pipeline, &push, sizeof push, groups);
  }
  /// Draws into a target in one pass. Clears colours to 0 and depths to `clear_depth` (0 is farthest) first. Executes
  /// `calls` (at least one) in order. Later passes see the result after a barrier().
  void draw(const RasterTarget& target, std::initializer_list<DrawCall> calls, float clear_depth = 0);
  /// Copies an image of a target drawn in this run: colours 0, 1, ..., then depth. Rows from the top; 16 bytes (four
  /// floats) per colour pixel, 4 per depth pixel.
  void copy(const RasterTarget& from, std::uint32_t image, const DeviceBuffer& to);
  /// Fills part of a buffer with a 32-bit word; offset and size as for upload().
  void fill(const DeviceBuffer& buffer, std::uint64_t offset, std::uint64_t bytes, std::uint32_t word);
  /// Copies part of a buffer to `to`, which is filled when run() returns; offset and size as for download(). Meant for
  /// counters: all reads of a run together have at most kMaxReadBytes. Sees the writes of earlier passes only after a
  /// barrier().
  void read(const DeviceBuffer& from, std::uint64_t offset, std::uint64_t bytes, void* to);
  static constexpr std::uint64_t kMaxReadBytes = 256;
  /// Full barrier: earlier commands finish, and their writes are visible, before later ones begin.
  void barrier();

  /// Runs the recorded commands and waits. Throws Error if the device is lost or has exceeded
  /// DeviceSettings::timeout_s, in this run or an earlier one.
  void run();
  /// Dispatches and draws of the last run(), in order.
  const std::vector<PassTime>& passes() const;

 private:
  void record_dispatch(const ComputePipeline& pipeline, const void* push, std::uint32_t bytes, const Groups& groups);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scarp
