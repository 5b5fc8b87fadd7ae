// SPDX-License-Identifier: MIT
// Compass directions in world space. Azimuths count clockwise from TRUE north; the world's y axis is the north of the
// raster's grid; the georeference relates it to true north.
#pragma once

#include "scarp/base/vec.h"

namespace scarp {

/// Returns the world unit vector towards a compass azimuth and an altitude above the horizon, in radians.
/// `grid_north_azimuth` is the compass azimuth of the world's y axis.
dvec3 towards(double azimuth, double altitude, double grid_north_azimuth);

}  // namespace scarp
