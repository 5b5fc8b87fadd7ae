// SPDX-License-Identifier: MIT
#include "scarp/vk/timestamps.h"

namespace scarp {

Timestamps::Timestamps(std::shared_ptr<Device::Impl> device) : device_(std::move(device)) {
  if (device_->timestamp_bits == 0) return;
  pool_.emplace(device_->device, vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, 2 * kMaxPasses));
}

void Timestamps::reset(const vk::raii::CommandBuffer& commands) {
  used_ = 0;
  if (pool_) commands.resetQueryPool(**pool_, 0, 2 * kMaxPasses);
}

void Timestamps::begin(const vk::raii::CommandBuffer& commands, vk::PipelineStageFlagBits stage) {
  if (pool_ && used_ < kMaxPasses) {
    commands.writeTimestamp(stage, **pool_, 2 * used_);
  }
}

void Timestamps::end(const vk::raii::CommandBuffer& commands, vk::PipelineStageFlagBits stage) {
  if (pool_ && used_ < kMaxPasses) {
    commands.writeTimestamp(stage, **pool_, 2 * used_ + 1);
    ++used_;
  }
}

std::vector<std::optional<double>> Timestamps::read(std::size_t passes) const {
  std::vector<std::optional<double>> times(passes);
  if (!pool_ || used_ == 0) return times;
  const auto [result, ticks] =
      pool_->getResults<std::uint64_t>(0, 2 * used_, 2 * used_ * sizeof(std::uint64_t), sizeof(std::uint64_t),
                                       vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
  // Counters narrower than 64 bits wrap around.
  const std::uint64_t mask = device_->timestamp_bits >= 64 ? ~0ull : (1ull << device_->timestamp_bits) - 1;
  for (std::size_t i = 0; i < std::min<std::size_t>(passes, used_); ++i) {
    times[i] = static_cast<double>((ticks[2 * i + 1] - ticks[2 * i]) & mask) * device_->timestamp_period_ns;
  }
  return times;
}

}  // namespace scarp
