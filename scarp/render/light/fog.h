// SPDX-License-Identifier: MIT
// Air that takes light away and gives its own: fog with distance, with height, and as the first ray casters had it.
//
//   seen = ground * T + colour of the fog * (1 - T), T the transmittance between eye and ground
//
//   distance    T = exp(-s t)                           the same air everywhere (Bouguer)
//   height      T = exp(-integral of s exp(-(z - z0) / H)), air that thins out upwards by the factor e every H metres:
//               with the ray's z = z_eye + t d the integral is s exp(-(z_eye - z0) / H) t (1 - exp(-x)) / x, x = t d /
//               H
//   iterations  T = 1 - steps / most steps              what a march cost, as the founding text on the semi-voxel
//               caster has it: it depends on how the march steps, and is kept for comparison
//
// s follows from the visibility V, at which 2 of 100 parts of a contrast are left: s = ln(50) / V (Koschmieder 1924).
// Towards the sun the fog is warm: its colour goes over to that of sunlight with the 8th power of the angle's cosine
// (I. Quilez, "Better fog", 2010).
#pragma once

#include <string_view>

#include "scarp/base/ray.h"

namespace scarp {

enum class FogKind { none, distance, height, iterations };

/// "none", "distance", "height", "iterations".
std::string_view name_of(FogKind kind);
/// Throws Error listing the names when there is no such fog.
FogKind find_fog(std::string_view name);

struct FogSettings {
  FogKind kind = FogKind::none;
  double visibility = 20000;  ///< metres, at the height `base`; > 0
  double base = 0;            ///< metres of world z where `visibility` holds; `height` alone
  double falloff = 300;       ///< metres in which the fog thins out by the factor e; > 0; `height` alone
  double sun_tint = 0.6;      ///< how far the colour goes over to sunlight, looking into the sun; 0..1
};

/// Throws Error naming the first setting out of its range.
void validate(const FogSettings& settings);

class Fog {
 public:
  /// `to_sun`: unit vector. The settings must be valid.
  Fog(const FogSettings& settings, const dvec3& to_sun);

  FogKind kind() const { return settings_.kind; }
  /// The share of light that comes through from the point `t` metres along the ray, whose direction has length 1; 0..1.
  /// t may be infinite: 1 for fog by distance, whose colour is that of the sky at the horizon anyway. For `iterations`
  /// it is 1.
  double transmittance(const Ray& ray, double t) const;
  /// Of the fog, in linear light, looking along a unit vector.
  vec3 colour(const dvec3& direction) const;
  double per_metre() const { return per_metre_; }
  const FogSettings& settings() const { return settings_; }
  /// A colour in linear light, seen through the fog.
  vec3 operator()(const Ray& ray, double t, vec3 behind) const;
  /// The same for `iterations`: `share` of the most steps, 0..1.
  vec3 by_share(const Ray& ray, double share, vec3 behind) const;

 private:
  FogSettings settings_;
  double per_metre_;
  dvec3 to_sun_;
};

}  // namespace scarp
