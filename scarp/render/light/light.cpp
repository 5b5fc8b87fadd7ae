// SPDX-License-Identifier: MIT
#include "scarp/render/light/light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "scarp/base/error.h"
#include "scarp/render/camera/compass.h"
#include "scarp/render/light/air.glsl.h"

namespace scarp {
void validate(const SunSettings& settings) {
  if (!std::isfinite(settings.azimuth_deg)) {
    throw Error(fmt::format("sun: the azimuth is {} (must be a finite number of degrees)", settings.azimuth_deg));
  }
  if (!(settings.altitude_deg > 0 && settings.altitude_deg <= 90)) {
    throw Error(fmt::format("sun: the altitude is {} (must be above 0 and at most 90 degrees)", settings.altitude_deg));
  }
  if (!(settings.size_deg >= 0 && settings.size_deg <= 90)) {
    throw Error(fmt::format("sun: the size is {} (must be 0 to 90 degrees)", settings.size_deg));
  }
}

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
