// SPDX-License-Identifier: MIT
#include "scarp/render/light/fog.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scarp/base/setting.h"
#include "scarp/render/light/air.glsl.h"
#include "scarp/render/light/fog_model.h"

namespace scarp {
namespace {

constexpr std::array<std::string_view, 4> kNames = {"none", "distance", "height", "iterations"};

const double kContrastLeft = std::log(50.0);

}  // namespace

std::string_view name_of(FogKind kind) { return kNames[static_cast<std::size_t>(kind)]; }

FogKind find_fog(std::string_view name) { return static_cast<FogKind>(find_setting("fog", kNames, name)); }

void validate(const FogSettings& settings) {
  require_setting("fog", std::isfinite(settings.visibility) && settings.visibility > 0, "the visibility",
                  settings.visibility, "above 0 metres");
  require_setting("fog", std::isfinite(settings.base), "the base", settings.base, "a finite height in metres");
  require_setting("fog", std::isfinite(settings.falloff) && settings.falloff > 0, "the falloff", settings.falloff,
                  "above 0 metres");
  require_setting("fog", settings.sun_tint >= 0 && settings.sun_tint <= 1, "the sun's tint", settings.sun_tint,
                  "0 to 1");
}

double transmittance(const FogSettings& settings, const Ray& ray, double t) {
  const auto kind = static_cast<int>(settings.kind);
  const double per_metre = kContrastLeft / settings.visibility, z = ray.origin.z, rise = ray.direction.z;
  if (std::isinf(t)) {
    return glsl::scarp_fog_transmittance_of_sky(kind, per_metre, settings.base, settings.falloff, z, rise);
  }
  return glsl::scarp_fog_transmittance(kind, per_metre, settings.base, settings.falloff, z, rise, t);
}

Fog::Fog(const FogSettings& settings, const Sky& sky)
    : settings_(settings), per_metre_(kContrastLeft / settings.visibility), sky_(sky) {}

vec3 Fog::colour(const dvec3& direction) const {
  return glsl::scarp_fog_colour(sky_.numbers(), direction, settings_.sun_tint);
}

vec3 Fog::operator()(const Ray& ray, double t, vec3 behind) const {
  if (settings_.kind == FogKind::none || settings_.kind == FogKind::iterations) return behind;
  return glsl::scarp_between(colour(ray.direction), behind, transmittance(settings_, ray, t));
}

vec3 Fog::by_share(const Ray& ray, double share, vec3 behind) const {
  return glsl::scarp_between(behind, colour(ray.direction), std::clamp(share, 0.0, 1.0));
}

}  // namespace scarp
