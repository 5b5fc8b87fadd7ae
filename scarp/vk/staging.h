// SPDX-License-Identifier: MIT
// Private to the station: host-visible memory in two halves; one is filled while the other is copied.
#pragma once

#include <array>

#include "scarp/vk/raii.h"

namespace scarp {

/// Returns memory bound to a buffer that the host reads and writes without flushes.
vk::raii::DeviceMemory host_memory(const Device::Impl& device, const vk::raii::Buffer& buffer);

class StagingRing {
 public:
  static constexpr std::uint64_t kPieceBytes = 16 << 20;

  explicit StagingRing(Device::Impl& device);
  ~StagingRing();

  using Fill = std::function<void(std::span<std::byte> piece, std::uint64_t first)>;
  void upload(const DeviceBuffer::Impl& to, const BufferRows& rows, const Fill& fill);
  void download(const DeviceBuffer::Impl& from, std::uint64_t offset, std::byte* to, std::uint64_t bytes);

 private:
  struct Half {
    vk::raii::CommandBuffer commands;
    vk::raii::Fence fence;
    std::byte* memory;
    bool running = false;
  };
  void wait(Half& half);
  template <class Record>
  void start(Half& half, Record&& record);

  Device::Impl& device_;
  vk::raii::Buffer buffer_;
  vk::raii::DeviceMemory memory_;
  std::vector<Half> halves_;
};

}  // namespace scarp
