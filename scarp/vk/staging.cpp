// SPDX-License-Identifier: MIT
#include "scarp/vk/staging.h"

#include <cstring>

namespace scarp {
namespace {

constexpr std::uint64_t kHalves = 2;

// Copies that scatter bytes [first, first + size) of the concatenated rows to their rows.
std::vector<vk::BufferCopy> copies_of(const BufferRows& rows, std::uint64_t half_begin, std::uint64_t first,
                                      std::uint64_t size) {
  if (rows.rows == 1 || rows.stride == rows.row_bytes) return {{half_begin, rows.offset + first, size}};
  std::vector<vk::BufferCopy> copies;
  for (std::uint64_t done = 0; done < size;) {
    const std::uint64_t row = (first + done) / rows.row_bytes, in_row = (first + done) % rows.row_bytes;
    const std::uint64_t part = std::min(rows.row_bytes - in_row, size - done);
    copies.push_back({half_begin + done, rows.offset + row * rows.stride + in_row, part});
    done += part;
  }
  return copies;
}

}  // namespace

vk::raii::DeviceMemory host_memory(const Device::Impl& device, const vk::raii::Buffer& buffer) {
  using Flag = vk::MemoryPropertyFlagBits;
  const vk::MemoryRequirements needs = buffer.getMemoryRequirements();
  // Cached memory is far faster to read; every device has coherent memory.
  auto type = device.memory_type(needs.memoryTypeBits, Flag::eHostVisible | Flag::eHostCoherent | Flag::eHostCached);
  if (!type) type = device.memory_type(needs.memoryTypeBits, Flag::eHostVisible | Flag::eHostCoherent);
  vk::raii::DeviceMemory memory(device.device, vk::MemoryAllocateInfo(needs.size, type.value()));
  buffer.bindMemory(*memory, 0);
  return memory;
}

StagingRing::StagingRing(Device::Impl& device)
    : device_(device),
      buffer_(device.device,
              vk::BufferCreateInfo({}, kHalves * kPieceBytes,
                                   vk::BufferUsageFlagBits::eTransferSrc | vk::BufferUsageFlagBits::eTransferDst)),
      memory_(host_memory(device, buffer_)) {
  auto* memory = static_cast<std::byte*>(memory_.mapMemory(0, kHalves * kPieceBytes));
  vk::raii::CommandBuffers commands(device.device, {*device.pool, vk::CommandBufferLevel::ePrimary, kHalves});
  for (std::size_t i = 0; i < kHalves; ++i) {
    halves_.push_back(
        {std::move(commands[i]), vk::raii::Fence(device.device, vk::FenceCreateInfo()), memory + i * kPieceBytes});
  }
}

StagingRing::~StagingRing() {
  for (const Half& half : halves_) {
    if (half.running) device_.wait_at_end(half.fence);
  }
}

void StagingRing::wait(Half& half) {
  if (!half.running) return;
  device_.wait(half.fence, "a copy");
  half.running = false;
}

template <class Record>
void StagingRing::start(Half& half, Record&& record) {
  half.commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  full_barrier(half.commands);
  record(half.commands);
  half.commands.end();
  device_.submit(half.commands, half.fence);
  half.running = true;
}

void StagingRing::upload(const DeviceBuffer::Impl& to, const BufferRows& rows, const Fill& fill) {
  const std::uint64_t bytes = rows.row_bytes * rows.rows;
  std::size_t turn = 0;
  for (std::uint64_t first = 0; first < bytes; first += kPieceBytes, turn = 1 - turn) {
    Half& half = halves_[turn];
    wait(half);
    const std::uint64_t size = std::min(kPieceBytes, bytes - first);
    fill({half.memory, size}, first);
    start(half, [&](const vk::raii::CommandBuffer& commands) {
      commands.copyBuffer(*buffer_, *to.buffer, copies_of(rows, turn * kPieceBytes, first, size));
    });
  }
  for (Half& half : halves_) wait(half);
}

void StagingRing::download(const DeviceBuffer::Impl& from, std::uint64_t offset, std::byte* to, std::uint64_t bytes) {
  // The device copies one half while the other is emptied.
  const auto begin = [&](std::uint64_t first) {
    const std::size_t turn = first / kPieceBytes % kHalves;
    start(halves_[turn], [&](const vk::raii::CommandBuffer& commands) {
      commands.copyBuffer(*from.buffer, *buffer_,
                          vk::BufferCopy(offset + first, turn * kPieceBytes, std::min(kPieceBytes, bytes - first)));
      const vk::MemoryBarrier to_host(vk::AccessFlagBits::eTransferWrite, vk::AccessFlagBits::eHostRead);
      commands.pipelineBarrier(vk::PipelineStageFlagBits::eTransfer, vk::PipelineStageFlagBits::eHost, {}, to_host, {},
                               {});
    });
  };
  begin(0);
  for (std::uint64_t first = 0; first < bytes; first += kPieceBytes) {
    if (first + kPieceBytes < bytes) begin(first + kPieceBytes);
    Half& half = halves_[first / kPieceBytes % kHalves];
    wait(half);
    std::memcpy(to + first, half.memory, std::min(kPieceBytes, bytes - first));
  }
}

}  // namespace scarp
