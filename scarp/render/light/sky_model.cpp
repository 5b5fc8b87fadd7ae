// SPDX-License-Identifier: MIT
#include "scarp/render/light/sky_model.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "scarp/render/light/air.glsl.h"
#include "scarp/render/light/atmosphere.h"
#include "scarp/render/light/sky_fit.h"

namespace scarp {
namespace {

constexpr double kPi = 3.14159265358979323846;
// Sine of the sun's altitude below which its light is no longer scaled up: level ground darkens in the evening.
constexpr double kLowestFullSun = 0.5;

// Angle above the sun at which the brightness of the sky is measured, radians: 15 degrees, half the default field of
// view, so that a picture of the sun is exposed for the sky at its border.
constexpr double kBesideSun = 0.26;

// Number of directions around the horizon for means.
constexpr int kAround = 48;

// Altitude of the sun for which sunlight is white, radians: 60 degrees.
constexpr double kNoon = kPi / 3;
// Radiance of white level ground in skylight, for a sun with an irradiance of 1, about that at sunset. Darker twilight
// is exposed by half as many stops as it lacks.
constexpr float kSunset = 0.004f;

// Luminance of linear sRGB (IEC 61966-2-1).
float luminance(vec3 colour) { return dot(colour, vec3(0.2126f, 0.7152f, 0.0722f)); }

// Cosine-weighted mean over the hemisphere: the radiance of white level ground in skylight.
vec3 mean_of(const glsl::ScarpSky& sky) {
  constexpr int kRings = 24;
  vec3 sum(0.0f);
  for (int ring = 0; ring < kRings; ++ring) {
    // Rings of equal area on the disc below the hemisphere have equal weights.
    const double level = std::sqrt((ring + 0.5) / kRings), up = std::sqrt(1 - level * level);
    for (int i = 0; i < kAround; ++i) {
      const double turn = 2 * kPi * (i + 0.5) / kAround;
      sum += glsl::scarp_sky_colour(sky, {level * std::cos(turn), level * std::sin(turn), up});
    }
  }
  return sum / static_cast<float>(kRings * kAround);
}

void scale_parts(glsl::ScarpSky& sky, vec3 factor) {
  for (glsl::ScarpSkyPart* part : {&sky.all, &sky.first, &sky.second, &sky.third, &sky.fourth}) {
    for (vec3* coefficient : {&part->even, &part->cosine, &part->square, &part->forward}) *coefficient *= factor;
  }
}

}  // namespace

Sky::Sky(const SkySettings& settings, const dvec3& to_sun, double sun_radius)
    : skylight_(glsl::kScarpSkylight),
      sunlight_((vec3(1.0f) - glsl::kScarpSkylight) / static_cast<float>(std::max(to_sun.z, kLowestFullSun))) {
  numbers_.to_sun = vec3(to_sun);
  if (settings.kind == SkyKind::plain) return;
  scatter(settings.turbidity, sun_radius);
  const double chord = 2 * std::sin(sun_radius / 2);
  numbers_.disc_square = static_cast<float>(chord * chord);
}

void Sky::scatter(double turbidity, double sun_radius) {
  const double up = numbers_.to_sun.z, altitude = std::asin(std::clamp(up, -1.0, 1.0));
  numbers_.scattering = 1;
  const Atmosphere atmosphere(turbidity, altitude);
  fit_sky(atmosphere, numbers_);
  const vec3 noon(atmosphere.sunlight(kNoon)), white = luminance(noon) / noon,
                                               full = vec3(atmosphere.sunlight(std::max(altitude, 0.0))) * white;
  scale_parts(numbers_, white);
  const double risen = sun_radius > 0 ? std::clamp(0.5 + altitude / (2 * sun_radius), 0.0, 1.0) : altitude > 0 ? 1 : 0;
  const vec3 sky = mean_of(numbers_), sun = full * static_cast<float>(risen / kPi);
  // Above a low sun the sky is brighter than the ground: the exposure is the geometric mean for both.
  const double beside = altitude + kBesideSun;
  const dvec2 level = dvec2(numbers_.to_sun.x, numbers_.to_sun.y) / std::max(std::cos(altitude), 1e-6);
  const float ground = luminance(sky + sun * static_cast<float>(std::max(up, kLowestFullSun))),
              above = luminance(colour({std::cos(beside) * level, std::sin(beside)})),
              twilight = std::sqrt(std::min(1.0f, ground / kSunset)),
              exposure = twilight / std::sqrt(ground * std::max(ground, above));
  skylight_ = sky * exposure;
  sunlight_ = sun * exposure;
  scale_parts(numbers_, vec3(exposure));
  for (int i = 0; i < kAround; ++i) {
    const double turn = 2 * kPi * (i + 0.5) / kAround;
    numbers_.horizon +=
        glsl::scarp_scattered(numbers_, {std::cos(turn), std::sin(turn), 0}) / static_cast<float>(kAround);
  }
  constexpr float kPaleGround = 0.4f;  // albedo
  numbers_.ground = kPaleGround * (skylight_ + sunlight_ * static_cast<float>(std::max(up, 0.0)));
  numbers_.disc = full * (kBrightest / luminance(full));
}

}  // namespace scarp
