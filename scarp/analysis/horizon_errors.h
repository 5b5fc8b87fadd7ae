// SPDX-License-Identifier: MIT
// How far the engine of some horizons is off, on a sample of nodes: each against every crossing in double.
#pragma once

#include <span>

#include "scarp/analysis/horizon.h"
#include "scarp/analysis/map_part.h"

namespace scarp {

/// Differences of angles, radians.
struct HorizonErrors {
  double median = 0, p99 = 0, largest = 0;
  int count = 0;  ///< of angles compared
};

/// Compares at most `angles` horizons in the rows of `band`, of at most eight of the azimuths (radians from grid
/// north). The same every time. Throws Error and Interrupted as Horizons does.
HorizonErrors sampled_horizon_errors(const HeightField& field, const HorizonSettings& settings,
                                     std::span<const double> azimuths, const RowBand& band, int angles = 2000,
                                     const Progress& progress = {});

}  // namespace scarp
