// SPDX-License-Identifier: MIT
// Detects samples that probably mark holes although the file does not declare them.
//
//   lowest sample            -32768, -32767, -9999, -99999, -999999, below -1e30
//   highest sample           above 1e30; the largest value of its type, if isolated
//   either                   if isolated by more than the relief of the Earth
//   zeros                    at a corner, below ground that is everywhere more than 100 m above zero
//
// A value is isolated if it is farther from the next value than all others are from each other; if there are only two
// values, the one farther from 0 is isolated.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scarp/source/raster/raster.h"

namespace scarp {

/// Nodata marks such as -3.4e38, 1e38 and 9.96e36 (netCDF's) exceed this; measured values do not.
inline constexpr double kBeyondHeights = 1e30;

/// Returns a note for the lowest and for the highest sample, each if it may mark holes; the note names the option that
/// declares it. `greatest` is the largest value of the file's sample type; nullopt for floats.
std::vector<std::string> suspected_nodata(const Raster& raster, std::optional<double> greatest);

}  // namespace scarp
