// SPDX-License-Identifier: MIT
#include "scarp/render/light/light.h"

#include <algorithm>
#include <glm/trigonometric.hpp>

#include "scarp/render/camera/compass.h"
#include "scarp/render/light/air.glsl.h"

namespace scarp {

Light::Light(const SunSettings& settings, double grid_north_azimuth, const SkySettings& sky)
    : to_sun_(towards(glm::radians(settings.azimuth_deg), glm::radians(settings.altitude_deg), grid_north_azimuth)),
      sun_radius_(glm::radians(settings.size_deg) / 2),
      sky_side_(normalize(dvec3(0, 0, 1) + 0.7 * towards(glm::radians(settings.azimuth_deg), 0, grid_north_azimuth))),
      sky_(sky, to_sun_, sun_radius_) {}

vec3 Light::on(const dvec3& normal, bool in_sun) const {
  return on(normal, in_sun ? std::max(0.0, dot(normal, to_sun_)) : 0.0, 1.0);
}

vec3 Light::on(const dvec3& normal, double sun_cosine, double sky_share) const {
  return glsl::scarp_light(normal, sky_side_, skylight(), sun(), sun_cosine, sky_share);
}

}  // namespace scarp
