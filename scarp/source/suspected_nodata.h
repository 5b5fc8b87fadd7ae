// SPDX-License-Identifier: MIT
// Samples that may mark holes although their file does not say so.
//
//   lowest sample            -32768, -32767, -9999, -99999, -999999, below -1e30
//   highest sample           above 1e30; the greatest of its type, if it lies apart
//   either                   if it lies apart by more than all the relief of the Earth
//
// A value lies apart when it is farther from the next one than all others are from each other; of two values the one
// farther from 0.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scarp/source/raster.h"

namespace scarp {

/// Marks such as -3.4e38, 1e38 and 9.96e36 (netCDF's) are beyond it, and nothing that is measured is.
inline constexpr double kBeyondHeights = 1e30;

/// A note for the lowest and for the highest sample, where it may mark holes: it names the option that says so.
/// `greatest` is the greatest value that samples of the file's type can have; nothing for floats.
std::vector<std::string> suspected_nodata(const Raster& raster, std::optional<double> greatest);

}  // namespace scarp
