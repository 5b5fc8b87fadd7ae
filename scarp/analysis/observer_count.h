// SPDX-License-Identifier: MIT
// Cumulative viewshed: how many observers see each node. Observers are swept concurrently, and all add to one map.
//
//   std::vector<scarp::Viewpoint> views = ...;   // over one field
//   const auto counts = scarp::observer_count(views);
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scarp/analysis/viewshed.h"
#include "scarp/base/progress.h"

namespace scarp {

inline constexpr std::uint16_t kCountHole = 65535;        ///< no sample
inline constexpr std::uint16_t kCountOutOfRange = 65534;  ///< outside the limits of all observers
inline constexpr std::size_t kMostObservers = 65533;

/// Returns for every node how many views see it, or one of the values above; rows from north to south. The fields of
/// all views have the same samples; their cells may differ. The result does not depend on the number of threads.
/// Takes 2 bytes per node. Throws Error for no view, more than kMostObservers, or fields of different sizes.
std::vector<std::uint16_t> observer_count(std::span<const Viewpoint> views, const Progress& progress = {});

}  // namespace scarp
