// SPDX-License-Identifier: MIT
#include "scarp/render/camera/compass.h"

#include <cmath>

namespace scarp {

dvec3 towards(double azimuth, double altitude, double grid_north_azimuth) {
  const double from_grid_north = azimuth - grid_north_azimuth, level = std::cos(altitude);
  return {std::sin(from_grid_north) * level, std::cos(from_grid_north) * level, std::sin(altitude)};
}

}  // namespace scarp
