// SPDX-License-Identifier: MIT
// Settings of the sun.
#pragma once

namespace scarp {

/// Lowest altitude of the sun in degrees: the end of civil twilight.
constexpr double kLowestSun = -6;

struct SunSettings {
  double azimuth_deg = 315;  ///< compass azimuth, clockwise from true north; finite
  double altitude_deg = 45;  ///< altitude of its centre above the horizon, kLowestSun..90; above 0 in a plain sky
  double size_deg = 0.533;   ///< apparent diameter, for soft shadows; 0 (a point) to 90
};

/// Throws Error naming the first setting out of range.
void validate(const SunSettings& settings);

}  // namespace scarp
