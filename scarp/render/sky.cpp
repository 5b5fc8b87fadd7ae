// SPDX-License-Identifier: MIT
#include "scarp/render/sky.h"

#include <cmath>

namespace scarp {
namespace {

constexpr vec3 kZenith(0.12f, 0.30f, 0.66f);
constexpr vec3 kHorizon(0.80f, 0.87f, 0.93f);
constexpr vec3 kNadir(0.60f, 0.66f, 0.72f);

// How fast the haze gives way: shares of the way to zenith and nadir go as 1 - (1 - |z|)^n.
constexpr double kClearing = 3.0;
constexpr double kSinking = 1.5;

vec3 mix(vec3 from, vec3 to, double share) {
  const auto f = static_cast<float>(share);
  return from * (1 - f) + to * f;
}

}  // namespace

vec3 sky_colour(double direction_z) {
  if (direction_z >= 0) return mix(kHorizon, kZenith, 1 - std::pow(1 - std::fmin(direction_z, 1.0), kClearing));
  return mix(kHorizon, kNadir, 1 - std::pow(1 - std::fmin(-direction_z, 1.0), kSinking));
}

vec3 haze_colour() { return kHorizon; }

}  // namespace scarp
