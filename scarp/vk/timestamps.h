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

  /// To be recorded outside of passes, before the first begin() of a run.
  void reset(const vk::raii::CommandBuffer& commands);
  /// When what was recorded before has passed the stage: the one in which the pass works, or the last of several.
  void begin(const vk::raii::CommandBuffer& commands, vk::PipelineStageFlagBits stage);
  void end(const vk::raii::CommandBuffer& commands, vk::PipelineStageFlagBits stage);
  /// How long each pass took, in nanoseconds; after the run. Nothing where the device has no timestamps, and for passes
  /// beyond kMaxPasses.
  std::vector<std::optional<double>> read(std::size_t passes) const;

  static constexpr std::uint32_t kMaxPasses = 512;  ///< of one run that are timed

 private:
  std::shared_ptr<Device::Impl> device_;
  std::optional<vk::raii::QueryPool> pool_;
  std::uint32_t used_ = 0;
};

}  // namespace scarp
