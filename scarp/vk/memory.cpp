// SPDX-License-Identifier: MIT
#include "scarp/vk/memory.h"

#include <fmt/format.h>

#include <cstring>

#include "scarp/vk/staging.h"

namespace scarp {
namespace {

std::string mebibytes(std::uint64_t bytes) { return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1 << 20)); }

vk::raii::Buffer make_buffer(const Device::Impl& device, std::uint64_t bytes) {
  using Usage = vk::BufferUsageFlagBits;
  return {device.device, vk::BufferCreateInfo({}, bytes,
                                              Usage::eStorageBuffer | Usage::eIndexBuffer | Usage::eTransferSrc |
                                                  Usage::eTransferDst | Usage::eShaderDeviceAddress)};
}

vk::raii::DeviceMemory make_memory(const Device::Impl& device, const vk::raii::Buffer& buffer) {
  const vk::MemoryRequirements needs = buffer.getMemoryRequirements();
  const auto type = device.memory_type(needs.memoryTypeBits, vk::MemoryPropertyFlagBits::eDeviceLocal);
  vk::StructureChain<vk::MemoryAllocateInfo, vk::MemoryAllocateFlagsInfo, vk::MemoryDedicatedAllocateInfo> allocate;
  allocate.get<vk::MemoryAllocateInfo>().setAllocationSize(needs.size).setMemoryTypeIndex(type.value());
  allocate.get<vk::MemoryAllocateFlagsInfo>().setFlags(vk::MemoryAllocateFlagBits::eDeviceAddress);
  allocate.get<vk::MemoryDedicatedAllocateInfo>().setBuffer(*buffer);
  return {device.device, allocate.get<vk::MemoryAllocateInfo>()};
}

StagingRing& staging_of(Device::Impl& device) {
  if (!device.staging) device.staging = std::make_unique<StagingRing>(device);
  return *device.staging;
}

void require_inside(const DeviceBuffer::Impl& buffer, std::uint64_t offset, std::uint64_t bytes) {
  if (offset % 4 == 0 && bytes % 4 == 0 && offset <= buffer.bytes && bytes <= buffer.bytes - offset) return;
  throw Error(fmt::format("device buffer '{}': bytes {} to {} of {} (must be multiples of 4 within the buffer)",
                          buffer.name, offset, offset + bytes, buffer.bytes));
}

}  // namespace

DeviceBuffer::DeviceBuffer(const Device& device, std::uint64_t bytes, const std::string& name) {
  const std::shared_ptr<Device::Impl>& open = device.impl();
  const DeviceDescription& description = open->description;
  if (bytes == 0 || bytes % 4 != 0) {
    throw Error(fmt::format("device buffer '{}': {} bytes (must be a positive multiple of 4)", name, bytes));
  }
  const auto refuse = [&](const std::string& limit) {
    throw Error(fmt::format("device '{}': no memory for {} ({}): {}", description.name, name, mebibytes(bytes), limit));
  };
  if (bytes > description.max_allocation_bytes) {
    refuse("buffers are limited to " + mebibytes(description.max_allocation_bytes));
  }
  if (bytes > description.memory_bytes) refuse("the device has " + mebibytes(description.memory_bytes));
  guarded(description.name, "making " + name, [&] {
    try {
      vk::raii::Buffer buffer = make_buffer(*open, bytes);
      vk::raii::DeviceMemory memory = make_memory(*open, buffer);
      buffer.bindMemory(*memory, 0);
      const std::uint64_t address = open->device.getBufferAddress({*buffer});
      impl_.reset(new Impl{open, name, bytes, std::move(memory), std::move(buffer), address});
    } catch (const vk::OutOfDeviceMemoryError&) {
      // The memory size that a CPU device reports is an arbitrary number from the driver, not a limit.
      refuse(description.kind == DeviceKind::cpu
                 ? "it uses system memory, and none is left"
                 : "the device has " + mebibytes(description.memory_bytes) + ", part of it in use");
    }
  });
}
DeviceBuffer::DeviceBuffer(DeviceBuffer&&) noexcept = default;
DeviceBuffer& DeviceBuffer::operator=(DeviceBuffer&&) noexcept = default;
DeviceBuffer::~DeviceBuffer() = default;

std::uint64_t DeviceBuffer::bytes() const { return impl_->bytes; }
std::uint64_t DeviceBuffer::address() const { return impl_->address; }

void upload(const DeviceBuffer& to, std::uint64_t offset, const void* from, std::uint64_t bytes) {
  upload_rows(to, {.offset = offset, .row_bytes = bytes}, [&](std::span<std::byte> piece, std::uint64_t first) {
    std::memcpy(piece.data(), static_cast<const std::byte*>(from) + first, piece.size());
  });
}

void upload_rows(const DeviceBuffer& to, const BufferRows& rows,
                 const std::function<void(std::span<std::byte> piece, std::uint64_t first)>& fill) {
  const DeviceBuffer::Impl& buffer = to.impl();
  if (rows.row_bytes == 0 || rows.rows == 0) return;
  require_inside(buffer, rows.offset, rows.row_bytes);
  if (rows.rows > 1) {
    if (rows.stride < rows.row_bytes || rows.rows - 1 > buffer.bytes / rows.stride) {
      throw Error(fmt::format("device buffer '{}': {} rows of {} bytes with a stride of {} exceed its {} bytes",
                              buffer.name, rows.rows, rows.row_bytes, rows.stride, buffer.bytes));
    }
    require_inside(buffer, rows.offset + (rows.rows - 1) * rows.stride, rows.row_bytes);
  }
  guarded(buffer.device->name(), "filling " + buffer.name,
          [&] { staging_of(*buffer.device).upload(buffer, rows, fill); });
}

void download(const DeviceBuffer& from, std::uint64_t offset, void* to, std::uint64_t bytes) {
  const DeviceBuffer::Impl& buffer = from.impl();
  require_inside(buffer, offset, bytes);
  if (bytes == 0) return;
  guarded(buffer.device->name(), "reading " + buffer.name,
          [&] { staging_of(*buffer.device).download(buffer, offset, static_cast<std::byte*>(to), bytes); });
}

}  // namespace scarp
