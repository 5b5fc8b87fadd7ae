// SPDX-License-Identifier: MIT
// The settings of the light on surfaces.
#pragma once

#include <cstdint>

#include "scarp/render/light/sky.h"
#include "scarp/render/light/sun.h"

namespace scarp {

/// The members are those of PictureSettings.
struct LightSettings {
  SunSettings sun{};
  SkySettings sky{};
  double grid_north_azimuth = 0;  ///< radians clockwise from true north
  bool shadows = true;            ///< whether surfaces block the sun
  bool unlit = false;             ///< surfaces keep their own colours
  int samples = 0;                ///< rays to the sun's disc, and as many to the sky, per point; 0: hard shadows
  int points_per_pixel = 1;       ///< number of points that share a pattern of samples
  std::uint32_t seed = 0;         ///< seed of the pattern
};

}  // namespace scarp
