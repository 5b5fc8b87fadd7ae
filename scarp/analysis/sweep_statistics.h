// SPDX-License-Identifier: MIT
// Statistics of a sweep over the nodes of a map.
#pragma once

#include <cstdint>

namespace scarp {

/// Counts of a sweep.
struct SweepStatistics {
  std::int64_t samples = 0;  ///< in all rings, including samples next to a part of a sector
  std::int64_t skipped = 0;  ///< in blocks below the horizon
  std::int64_t careful = 0;  ///< not certainly below the horizon
  std::int64_t walked = 0;   ///< left to a ray

  void add(const SweepStatistics& other) {
    samples += other.samples;
    skipped += other.skipped;
    careful += other.careful;
    walked += other.walked;
  }
};

}  // namespace scarp
