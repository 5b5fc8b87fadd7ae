// SPDX-License-Identifier: MIT
// Settings of the sun.
#pragma once

namespace scarp {

struct SunSettings {
  double azimuth_deg = 315;  ///< compass azimuth, clockwise from true north; finite
  double altitude_deg = 45;  ///< altitude of its centre above the horizon; above 0, at most 90
  double size_deg = 0.533;   ///< apparent diameter, for soft shadows; 0 (a point) to 90
};

/// Throws Error naming the first setting out of range.
void validate(const SunSettings& settings);

}  // namespace scarp
