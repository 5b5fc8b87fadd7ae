// SPDX-License-Identifier: MIT
// Private to the station: timestamps before and after each pass.
#pragma once

#include <optional>
#include <vector>

#include "scarp/vk/raii.h"

namespace scarp {

class Timestamps {
 public:
  explicit Timestamps(std::shared_ptr<Device::Impl> device);

  /// Records a reset. Call outside passes, before the first begin() of a run.
  void reset(const vk::raii::CommandBuffer& commands);
  /// Record a timestamp when earlier commands have passed `stage`: the pass's stage, or its last one if there are
  /// several.
  void begin(const vk::raii::CommandBuffer& commands, vk::PipelineStageFlagBits stage);
  void end(const vk::raii::CommandBuffer& commands, vk::PipelineStageFlagBits stage);
  /// Returns the durations of the passes in nanoseconds; call it after the run. Empty if the device has no timestamps,
  /// and for passes beyond kMaxPasses.
  std::vector<std::optional<double>> read(std::size_t passes) const;

  static constexpr std::uint32_t kMaxPasses = 512;  ///< timed passes per run

 private:
  std::shared_ptr<Device::Impl> device_;
  std::optional<vk::raii::QueryPool> pool_;
  std::uint32_t used_ = 0;
};

}  // namespace scarp
