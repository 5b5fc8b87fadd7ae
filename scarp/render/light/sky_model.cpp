// SPDX-License-Identifier: MIT
#include "scarp/render/light/sky_model.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "scarp/render/light/air.glsl.h"

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

// A value that is linear in the turbidity.
struct Line {
  double slope, offset;
  double operator()(double turbidity) const { return slope * turbidity + offset; }
};

// Preetham et al. 1999, appendix A.2: Perez's coefficients of Y, x and y.
constexpr Line kPerez[5][3] = {{{0.1787, -1.4630}, {-0.0193, -0.2592}, {-0.0167, -0.2608}},
                               {{-0.3554, 0.4275}, {-0.0665, 0.0008}, {-0.0950, 0.0092}},
                               {{-0.0227, 5.3251}, {-0.0004, 0.2125}, {-0.0079, 0.2102}},
                               {{0.1206, -2.5771}, {-0.0641, -0.8989}, {-0.0441, -1.6537}},
                               {{-0.0670, 0.3703}, {-0.0033, 0.0452}, {-0.0109, 0.0529}}};

// Ibid.: the zenith's x and y, by powers 2 to 0 of the turbidity and 3 to 0 of the sun's angle from the zenith.
constexpr double kZenithX[3][4] = {
    {0.00166, -0.00375, 0.00209, 0}, {-0.02903, 0.06377, -0.03202, 0.00394}, {0.11693, -0.21196, 0.06052, 0.25886}};
constexpr double kZenithY[3][4] = {
    {0.00275, -0.00610, 0.00317, 0}, {-0.04214, 0.08970, -0.04153, 0.00516}, {0.15346, -0.26756, 0.06670, 0.26688}};

double chromaticity(const double (&rows)[3][4], double turbidity, double angle) {
  double sum = 0;
  for (const auto& row : rows) sum = sum * turbidity + ((row[0] * angle + row[1]) * angle + row[2]) * angle + row[3];
  return sum;
}

// Luminance of the zenith, kcd/m^2.
double zenith_luminance(double turbidity, double angle) {
  const double chi = (4.0 / 9 - turbidity / 120) * (kPi - 2 * angle);
  return (4.0453 * turbidity - 4.9710) * std::tan(chi) - 0.2155 * turbidity + 2.4192;
}

// Sunlight on a surface that faces it, klx: ibid., appendix A.1, without mixed gases and water vapour, which absorb
// little at these wavelengths.
vec3 sunlight_below_air(double turbidity, double altitude) {
  constexpr double kAbove = 128, kOzone = 0.0035;        // klx; metres
  constexpr double kWavelength[3] = {0.65, 0.55, 0.45};  // micrometres
  constexpr double kOzonePerMetre[3] = {6.7, 8.5, 0.3};  // ibid., table 2
  const double mass = 1 / (std::sin(altitude) + 0.15 * std::pow(glm::degrees(altitude) + 3.885, -1.253));
  const double aerosols = 0.04608 * turbidity - 0.04586;  // Angstrom's turbidity
  vec3 light;
  for (int i = 0; i < 3; ++i) {
    const double rayleigh = 0.008735 * std::pow(kWavelength[i], -4.08),
                 aerosol = aerosols * std::pow(kWavelength[i], -1.3);
    light[i] = static_cast<float>(kAbove * std::exp(-mass * (rayleigh + aerosol + kOzone * kOzonePerMetre[i])));
  }
  return light;
}

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

}  // namespace

Sky::Sky(const SkySettings& settings, const dvec3& to_sun, double sun_radius)
    : skylight_(glsl::kScarpSkylight),
      sunlight_((vec3(1.0f) - glsl::kScarpSkylight) / static_cast<float>(std::max(to_sun.z, kLowestFullSun))) {
  numbers_.to_sun = vec3(to_sun);
  if (settings.kind == SkyKind::plain) return;
  scatter(settings.turbidity);
  const double chord = 2 * std::sin(sun_radius / 2);
  numbers_.disc_square = static_cast<float>(chord * chord);
}

void Sky::scatter(double turbidity) {
  const double up = numbers_.to_sun.z, altitude = std::asin(std::min(1.0, up)), angle = kPi / 2 - altitude;
  numbers_.scattering = 1;
  for (int i = 0; i < 3; ++i) {
    int j = 0;
    for (vec3* coefficient : {&numbers_.a, &numbers_.b, &numbers_.c, &numbers_.d, &numbers_.e})
      (*coefficient)[i] = static_cast<float>(kPerez[j++][i](turbidity));
  }
  const dvec3 zenith(zenith_luminance(turbidity, angle), chromaticity(kZenithX, turbidity, angle),
                     chromaticity(kZenithY, turbidity, angle));
  for (int i = 0; i < 3; ++i) {
    const float there =
        glsl::scarp_perez(numbers_.a[i], numbers_.b[i], numbers_.c[i], numbers_.d[i], numbers_.e[i], 1, angle, up);
    numbers_.zenith[i] = static_cast<float>(zenith[i]) / there;
  }
  const vec3 sky = mean_of(numbers_), sun = sunlight_below_air(turbidity, altitude) / static_cast<float>(kPi);
  // Above a low sun the sky is brighter than the ground: the exposure is the geometric mean for both.
  const double beside = std::min(kPi / 2, altitude + kBesideSun);
  const dvec2 level = dvec2(numbers_.to_sun.x, numbers_.to_sun.y) / std::max(std::cos(altitude), 1e-6);
  const float ground = luminance(sky + sun * static_cast<float>(std::max(up, kLowestFullSun))),
              above = luminance(colour({std::cos(beside) * level, std::sin(beside)})),
              exposure = 1 / std::sqrt(ground * std::max(ground, above));
  skylight_ = sky * exposure;
  sunlight_ = sun * exposure;
  numbers_.zenith.x *= exposure;
  for (int i = 0; i < kAround; ++i) {
    const double turn = 2 * kPi * (i + 0.5) / kAround;
    numbers_.horizon +=
        glsl::scarp_scattered(numbers_, {std::cos(turn), std::sin(turn), 0}) / static_cast<float>(kAround);
  }
  constexpr float kPaleGround = 0.4f;  // albedo
  numbers_.ground = kPaleGround * (skylight_ + sunlight_ * static_cast<float>(up));
  numbers_.disc = sunlight_ * (kBrightest / luminance(sunlight_));
}

}  // namespace scarp
