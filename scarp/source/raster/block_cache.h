// SPDX-License-Identifier: MIT
// The memory that GDAL takes for decoded blocks of files.
#pragma once

#include <cstdint>

namespace scarp {

/// While it exists, GDAL keeps at most so many bytes of blocks, in all files: for parts that are read once. A lower
/// limit of the user stays. One at a time.
class BlockCacheLimit {
 public:
  explicit BlockCacheLimit(std::int64_t bytes);
  ~BlockCacheLimit();
  BlockCacheLimit(const BlockCacheLimit&) = delete;
  BlockCacheLimit& operator=(const BlockCacheLimit&) = delete;

 private:
  std::int64_t before_;
};

}  // namespace scarp
