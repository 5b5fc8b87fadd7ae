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
namespace {

// Below sin(30 degrees) the sun is not made stronger any more: level ground darkens in the evening.
constexpr double kLowestFullSun = 0.5;

}  // namespace

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

Light::Light(const SunSettings& settings, double grid_north_azimuth)
    : to_sun_(towards(glm::radians(settings.azimuth_deg), glm::radians(settings.altitude_deg), grid_north_azimuth)),
      sun_radius_(glm::radians(settings.size_deg) / 2),
      sky_side_(normalize(dvec3(0, 0, 1) + 0.7 * towards(glm::radians(settings.azimuth_deg), 0, grid_north_azimuth))),
      sun_((vec3(1.0f) - glsl::kScarpSkylight) / static_cast<float>(std::max(to_sun_.z, kLowestFullSun))) {}

vec3 Light::on(const dvec3& normal, bool in_sun) const {
  return on(normal, in_sun ? std::max(0.0, dot(normal, to_sun_)) : 0.0, 1.0);
}

vec3 Light::on(const dvec3& normal, double sun_cosine, double sky_share) const {
  return glsl::scarp_light(normal, sky_side_, sun_, sun_cosine, sky_share);
}

}  // namespace scarp
