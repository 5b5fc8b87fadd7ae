// SPDX-License-Identifier: MIT
// Private to the station: device memory that is kept from picture to picture.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scarp/vk/device.h"
#include "scarp/vk/memory.h"

namespace scarp {

/// A buffer that is reallocated when too small, and written only when its contents change.
class KeptBuffer {
 public:
  explicit KeptBuffer(const char* name) : name_(name) {}

  /// Ensures this size; contents are lost when it grows.
  const DeviceBuffer& reserve(const Device& device, std::uint64_t bytes) {
    if (!buffer_ || buffer_->bytes() < bytes) {
      buffer_.reset();
      kept_.clear();
      buffer_.emplace(device, bytes, name_);
    }
    return *buffer_;
  }
  template <class T>
  std::uint64_t keep(const Device& device, std::span<const T> values) {
    const std::span<const std::byte> bytes = std::as_bytes(values);
    if (buffer_ && std::equal(bytes.begin(), bytes.end(), kept_.begin(), kept_.end())) return buffer_->address();
    reserve(device, bytes.size());
    upload(*buffer_, 0, bytes.data(), bytes.size());
    kept_.assign(bytes.begin(), bytes.end());
    return buffer_->address();
  }

  const DeviceBuffer& buffer() const { return *buffer_; }

 private:
  const char* name_;
  std::optional<DeviceBuffer> buffer_;
  std::vector<std::byte> kept_;
};

}  // namespace scarp
