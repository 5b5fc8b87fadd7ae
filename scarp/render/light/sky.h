// SPDX-License-Identifier: MIT
// What rays see that meet nothing: a clear sky above, haze at the horizon, and below it a pale ground that a terrain
// model stands out against.
#pragma once

#include "scarp/base/vec.h"

namespace scarp {

/// Colour in linear light towards a direction whose unit vector has this z.
vec3 sky_colour(double direction_z);

/// Colour of far haze in linear light: that of the horizon.
vec3 haze_colour();

}  // namespace scarp
