// SPDX-License-Identifier: MIT
// Air that absorbs light and adds its own: fog by distance, by height, and by step count as in early ray casters.
//
//   seen = ground * T + colour of the fog * (1 - T), T the transmittance between eye and ground
//
//   distance    T = exp(-s t)                           the same air everywhere (Bouguer)
//   height      T = exp(-integral of s exp(-(z - z0) / H)), air that thins out upwards by the factor e every H metres:
//               with the ray's z = z_eye + t d the integral is s exp(-(z_eye - z0) / H) t (1 - exp(-x)) / x, where
//               x = t d / H
//   iterations  T = 1 - steps / most steps              cost of the march, as in the founding text on the semi-
//               voxel caster: it depends on how the march steps, and is kept for comparison
//
// s follows from the visibility V, at which 2 % of a contrast are left: s = ln(50) / V (Koschmieder 1924). The colour
// of the fog is that of the sky at the horizon. Below a plain sky, which has no sun disc, it blends to the colour of
// sunlight towards the sun, by the 8th power of the cosine (I. Quilez, "Better fog", 2010).
#pragma once

#include <string_view>

#include "scarp/base/ray.h"

namespace scarp {

enum class FogKind { none, distance, height, iterations };

/// "none", "distance", "height", "iterations".
std::string_view name_of(FogKind kind);
/// Throws Error listing the names if the fog is unknown.
FogKind find_fog(std::string_view name);

struct FogSettings {
  FogKind kind = FogKind::none;
  double visibility = 20000;  ///< metres, at the height `base`; > 0
  double base = 0;            ///< metres of world z where `visibility` holds; `height` only
  double falloff = 300;       ///< metres in which the fog thins out by the factor e; > 0; `height` only
  double sun_tint = 0.6;      ///< fraction of the colour of sunlight, looking into the sun; 0..1; plain sky only
};

/// Throws Error naming the first setting out of range.
void validate(const FogSettings& settings);

/// Returns the fraction of light, 0..1, transmitted from the point `t` metres along the ray, whose direction has length
/// 1. t may be infinite; the result is then 1 for fog by distance, whose colour is that of the sky at the horizon
/// anyway. Returns 1 for `iterations`.
double transmittance(const FogSettings& settings, const Ray& ray, double t);

}  // namespace scarp
