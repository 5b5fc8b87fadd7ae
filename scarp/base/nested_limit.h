// SPDX-License-Identifier: MIT
// Lowers a limit of a library for the whole process, for the lifetime of an object.
#pragma once

#include <cstdint>
#include <mutex>

namespace scarp {

/// Limits what `kGet` returns and `kSet` sets to `kMost`. A lower limit set by the user stays. Objects of the same type
/// may exist at the same time, on any thread.
template <auto kGet, auto kSet, std::int64_t kMost>
class NestedLimit {
 public:
  NestedLimit() {
    const std::lock_guard lock(mutex_);
    if (count_++ > 0) return;
    before_ = kGet();
    if (before_ > kMost) kSet(kMost);
  }
  ~NestedLimit() {
    const std::lock_guard lock(mutex_);
    if (--count_ == 0) kSet(before_);
  }
  NestedLimit(const NestedLimit&) = delete;
  NestedLimit& operator=(const NestedLimit&) = delete;

 private:
  static inline std::mutex mutex_;
  static inline int count_ = 0;
  static inline std::int64_t before_ = 0;
};

/// Room for the blocks of a virtual raster's sources that two pieces share, in addition to the blocks of one piece. By
/// default, GDAL's block cache takes a twentieth of the machine's memory.
inline constexpr std::int64_t kGdalCacheBytes = 64 << 20;

}  // namespace scarp
