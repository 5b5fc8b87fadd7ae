// SPDX-License-Identifier: MIT
// One part of a sector of a viewshed: see viewshed_sweep.h.
#pragma once

#include <atomic>

#include "scarp/analysis/block_maxima.h"
#include "scarp/analysis/sight_edges.h"
#include "scarp/analysis/viewshed_sweep.h"

namespace scarp {

/// Samples of a sector with low <= u < high, or <= high where high is the sector's end. Diagonals belong to the sectors
/// to the east and west.
struct SectorPart {
  SweepDirection direction = SweepDirection::east;
  double low = -1;  ///< a multiple of 1/16, as `high`
  double high = 1;
};

/// Maps that a sweep writes, and maxima that it reads. One of the maps is not null.
struct SectorMaps {
  Seen* codes = nullptr;    ///< `hidden` nodes that are visible are set to `visible`
  double* least = nullptr;  ///< the least visible height is set at nodes that are not NaN
  /// Counts are increased by one at visible nodes. Other sweeps may add to the same map concurrently.
  std::uint16_t* counts = nullptr;
  const BlockMaxima* maxima = nullptr;  ///< of the field, for `codes` and `counts`; null: no block is skipped
};

/// Atomically adds one to the count of a node.
inline void add_visible(std::uint16_t& count) { std::atomic_ref(count).fetch_add(1, std::memory_order_relaxed); }

SweepStatistics sweep_sector(const Viewpoint& view, const SectorPart& part, const SectorMaps& maps);

}  // namespace scarp
