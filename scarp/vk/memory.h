// SPDX-License-Identifier: MIT
// Memory of the device: few buffers that live long, each with an allocation of its own, and one staging ring through
// which everything comes and goes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "scarp/vk/device.h"

namespace scarp {

/// A buffer in the device's own memory, for shaders (by its address) and transfers.
class DeviceBuffer {
 public:
  /// `bytes` > 0, a multiple of 4. `name` is for messages. Contents are undefined. Throws Error when the device does
  /// not have the memory: how much was asked, and how much there is.
  DeviceBuffer(const Device& device, std::uint64_t bytes, const std::string& name);
  DeviceBuffer(DeviceBuffer&&) noexcept;
  DeviceBuffer& operator=(DeviceBuffer&&) noexcept;
  ~DeviceBuffer();

  std::uint64_t bytes() const;
  /// For buffer references of shaders; a multiple of 16.
  std::uint64_t address() const;

  struct Impl;  // raii.h
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// Copies to and from a buffer; they return when the copy is done. Offsets and sizes are multiples of 4 and inside
/// the buffer. Throws Error when the device is lost.
void upload(const DeviceBuffer& to, std::uint64_t offset, const void* from, std::uint64_t bytes);
void download(const DeviceBuffer& from, std::uint64_t offset, void* to, std::uint64_t bytes);

/// Part of a buffer: `rows` rows of `row_bytes`, from the begin of one to the next `stride` bytes (all multiples of 4).
struct BufferRows {
  std::uint64_t offset = 0;
  std::uint64_t row_bytes = 0;
  std::uint64_t rows = 1;
  std::uint64_t stride = 0;  ///< >= row_bytes; means nothing for one row
};
/// Uploads what `fill(piece, first)` writes: bytes [first, first + piece.size()) of the rows set one after another, in
/// pieces of some megabytes that begin and end at multiples of 4. One piece is filled while another is copied.
void upload_rows(const DeviceBuffer& to, const BufferRows& rows,
                 const std::function<void(std::span<std::byte> piece, std::uint64_t first)>& fill);

}  // namespace scarp
