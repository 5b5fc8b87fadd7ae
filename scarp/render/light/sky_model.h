// SPDX-License-Identifier: MIT
// A sky, and the light that it and the sun give.
//
//   Perez's formula   F = (1 + a exp(b / cos z)) (1 + c exp(d g) + e cos^2 g), z from the zenith, g from the sun
//   Preetham et al.   a to e and the zenith's Y, x, y as functions of turbidity and sun;   Y = Yz F / F(zenith)
//   sunlight          128 klx above the air, times what Rayleigh scattering, aerosols and ozone leave of it at 650, 550
//                     and 450 nm, along the air mass of Kasten (1965)
//   skylight          the sky's mean over the hemisphere, by its cosine
//
// All of it is scaled together: level ground that reflects all light has the luminance 1 below a high sun, and less
// below a sun that the sky is brighter above. The sun's disc is ten thousand times as bright as the sky; pictures cut
// it off at kBrightest, so that its edge can be anti-aliased.
#pragma once

#include "scarp/base/vec.h"
#include "scarp/render/light/sky.glsl.h"
#include "scarp/render/light/sky.h"

namespace scarp {

/// Luminance of the sun's disc and of its reflections, at most.
constexpr float kBrightest = 8;

class Sky {
 public:
  /// `to_sun`: unit vector, above the horizon; `sun_radius` in radians. The settings must be valid.
  Sky(const SkySettings& settings, const dvec3& to_sun, double sun_radius);

  bool scatters() const { return numbers_.scattering != 0; }
  /// In linear light towards a unit vector, without the sun's disc.
  vec3 colour(const dvec3& direction) const { return glsl::scarp_sky_colour(numbers_, direction); }
  /// What the sun's disc adds to that: 0 outside of it, and in a plain sky.
  vec3 disc(const dvec3& direction) const { return glsl::scarp_sun_disc(numbers_, direction); }
  /// Light of the sky on level ground.
  vec3 skylight() const { return skylight_; }
  /// Light of the sun on what faces it.
  vec3 sunlight() const { return sunlight_; }
  const glsl::ScarpSky& numbers() const { return numbers_; }

 private:
  void scatter(double turbidity);

  glsl::ScarpSky numbers_{};
  vec3 skylight_, sunlight_;
};

}  // namespace scarp
