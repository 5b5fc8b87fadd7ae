// SPDX-License-Identifier: MIT
// Device memory: a few long-lived buffers, each with its own allocation, and one staging ring for all transfers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "scarp/vk/device.h"

namespace scarp {

/// A buffer in device-local memory, for shaders (by address) and transfers.
class DeviceBuffer {
 public:
  /// `bytes` > 0, a multiple of 4. `name` is for messages. Contents are undefined. Throws Error if the device lacks the
  /// memory, stating the requested and the available size.
  DeviceBuffer(const Device& device, std::uint64_t bytes, const std::string& name);
  DeviceBuffer(DeviceBuffer&&) noexcept;
  DeviceBuffer& operator=(DeviceBuffer&&) noexcept;
  ~DeviceBuffer();

  std::uint64_t bytes() const;
  /// Address for buffer references in shaders; a multiple of 16.
  std::uint64_t address() const;

  struct Impl;  // raii.h
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// Copy to and from a buffer; return when the copy is complete. Offsets and sizes are multiples of 4 and within the
/// buffer. Throw Error if the device is lost.
void upload(const DeviceBuffer& to, std::uint64_t offset, const void* from, std::uint64_t bytes);
void download(const DeviceBuffer& from, std::uint64_t offset, void* to, std::uint64_t bytes);

/// Part of a buffer: `rows` rows of `row_bytes` bytes, `stride` bytes apart (all multiples of 4).
struct BufferRows {
  std::uint64_t offset = 0;
  std::uint64_t row_bytes = 0;
  std::uint64_t rows = 1;
  std::uint64_t stride = 0;  ///< >= row_bytes; ignored if rows == 1
};
/// Uploads rows in pieces of some megabytes. fill(piece, first) writes bytes [first, first + piece.size()) of the
/// concatenated rows; pieces begin and end at multiples of 4. One piece is filled while another is copied.
void upload_rows(const DeviceBuffer& to, const BufferRows& rows,
                 const std::function<void(std::span<std::byte> piece, std::uint64_t first)>& fill);

}  // namespace scarp
