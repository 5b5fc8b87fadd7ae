// SPDX-License-Identifier: MIT
// Work for the device: recorded in order, run as one, each pass between two timestamps.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "scarp/vk/device.h"
#include "scarp/vk/memory.h"
#include "scarp/vk/pipeline.h"

namespace scarp {

/// One dispatch that has run.
struct PassTime {
  std::string name;                   ///< of its pipeline
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
  /// Writes one 32-bit word all over a part of a buffer; offset and size as for upload().
  void fill(const DeviceBuffer& buffer, std::uint64_t offset, std::uint64_t bytes, std::uint32_t word);
  /// What was recorded before is done, and its writes are seen, before what comes after begins.
  void barrier();

  /// Runs what was recorded and waits. Throws Error when the device is lost or has not finished within
  /// DeviceSettings::timeout_s.
  void run();
  /// The dispatches of the last run(), in order.
  const std::vector<PassTime>& passes() const;

 private:
  void record_dispatch(const ComputePipeline& pipeline, const void* push, std::uint32_t bytes, const Groups& groups);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scarp
