// SPDX-License-Identifier: MIT
#include "scarp/render/fog.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scarp/base/error.h"
#include "scarp/render/sky.h"

namespace scarp {
namespace {

constexpr std::array<std::string_view, 4> kNames = {"none", "distance", "height", "iterations"};

const double kContrastLeft = std::log(50.0);
constexpr vec3 kSunlight(1.0f, 0.83f, 0.58f);

void require(bool good, std::string_view what, double value, std::string_view range) {
  if (!good) throw Error(fmt::format("fog: {} is {}; it must be {}", what, value, range));
}

// (1 - exp(-x)) / x, which goes through 1 at 0.
double mean_of_decay(double x) { return x == 0 ? 1 : -std::expm1(-x) / x; }

vec3 mix(vec3 from, vec3 to, double share) {
  const auto f = static_cast<float>(share);
  return from * (1 - f) + to * f;
}

}  // namespace

std::string_view name_of(FogKind kind) { return kNames[static_cast<std::size_t>(kind)]; }

FogKind find_fog(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<FogKind>(i);
  }
  throw Error(fmt::format("fog '{}': unknown; there are: {}", name, fmt::join(kNames, ", ")));
}

void validate(const FogSettings& settings) {
  require(std::isfinite(settings.visibility) && settings.visibility > 0, "the visibility", settings.visibility,
          "above 0 metres");
  require(std::isfinite(settings.base), "the base", settings.base, "a finite height in metres");
  require(std::isfinite(settings.falloff) && settings.falloff > 0, "the falloff", settings.falloff, "above 0 metres");
  require(settings.sun_tint >= 0 && settings.sun_tint <= 1, "the sun's tint", settings.sun_tint, "0 to 1");
}

Fog::Fog(const FogSettings& settings, const dvec3& to_sun)
    : settings_(settings), per_metre_(kContrastLeft / settings.visibility), to_sun_(to_sun) {}

double Fog::transmittance(const Ray& ray, double t) const {
  switch (settings_.kind) {
    case FogKind::distance:
      return std::isinf(t) ? 1 : std::exp(-per_metre_ * t);
    case FogKind::height: {
      const double here = per_metre_ * std::exp(-(ray.origin.z - settings_.base) / settings_.falloff);
      const double rise = ray.direction.z / settings_.falloff;
      if (std::isinf(t)) return rise > 0 ? std::exp(-here / rise) : 0;
      return std::exp(-here * t * mean_of_decay(t * rise));
    }
    case FogKind::none:
    case FogKind::iterations:
      break;
  }
  return 1;
}

vec3 Fog::colour(const dvec3& direction) const {
  double towards = std::max(0.0, dot(direction, to_sun_));
  for (int i = 0; i < 3; ++i) towards *= towards;  // the 8th power
  return mix(haze_colour(), kSunlight, settings_.sun_tint * towards);
}

vec3 Fog::operator()(const Ray& ray, double t, vec3 behind) const {
  if (settings_.kind == FogKind::none || settings_.kind == FogKind::iterations) return behind;
  return mix(colour(ray.direction), behind, transmittance(ray, t));
}

vec3 Fog::by_share(const Ray& ray, double share, vec3 behind) const {
  return mix(behind, colour(ray.direction), std::clamp(share, 0.0, 1.0));
}

}  // namespace scarp
