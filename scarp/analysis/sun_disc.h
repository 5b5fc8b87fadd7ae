// SPDX-License-Identifier: MIT
// The sun's disc as horizontal strips of equal height, each of which is visible if its middle is.
#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "scarp/analysis/sun_ground.h"

namespace scarp {

/// Mean angular diameter, radians.
inline constexpr double kSunDiameter = 0.533 * std::numbers::pi / 180;

struct SunStrip {
  double rise;  ///< height of its middle above the sun's centre, radians
  float share;  ///< fraction of the disc's area
};

/// Strips from the lowest to the highest.
std::span<const SunStrip> sun_strips();

/// Value of holes in maps of lit shares.
inline constexpr float kNoShare = -1;

/// Returns the lit fraction of the disc, 0..1, for every node of the band; kNoShare for holes. Strips below the horizon
/// are dark. Throws as SunGround::rows() does.
std::vector<float> lit_share(const SunGround& ground, const SunDirection& sun, const RowBand& band,
                             const Progress& progress = {});

}  // namespace scarp
