// SPDX-License-Identifier: MIT
#include "scarp/render/light/sky.h"

#include "scarp/render/light/air.glsl.h"

namespace scarp {

vec3 sky_colour(double direction_z) { return glsl::scarp_sky_colour(direction_z); }

vec3 haze_colour() { return glsl::kScarpHorizon; }

}  // namespace scarp
