// SPDX-License-Identifier: MIT
// The radiance of the sky, and the light of sky and sun on surfaces.
//
//   sky       a formula (sky.glsl.h) that is fitted to the integrals of atmosphere.h
//   sunlight  its transmittance through the same atmosphere
//   skylight  cosine-weighted mean of the sky over the hemisphere
//
// White balance: sunlight is white for a sun at 60 degrees, so shadows and the sky are blue, and a low sun is orange.
//
// One exposure scales everything: white level ground has the luminance 1 under a high sun, and less under a low sun,
// where the sky above the sun is brighter than the ground. Twilight is darker than the sunset. The sun's disc is more
// than ten thousand times as bright as the sky; it is limited to kBrightest so that its edge can be anti-aliased.
#pragma once

#include "scarp/base/vec.h"
#include "scarp/render/light/sky.glsl.h"
#include "scarp/render/light/sky.h"

namespace scarp {

/// Maximum luminance of the sun's disc and of its reflections.
constexpr float kBrightest = 8;

class Sky {
 public:
  /// `to_sun`: unit vector, in a plain sky above the horizon; `sun_radius` in radians. The settings must be valid.
  Sky(const SkySettings& settings, const dvec3& to_sun, double sun_radius);

  bool scatters() const { return numbers_.scattering != 0; }
  /// Colour of the sky in linear light towards a unit vector, without the sun's disc.
  vec3 colour(const dvec3& direction) const { return glsl::scarp_sky_colour(numbers_, direction); }
  /// Returns the radiance of the sun's disc, to be added to colour(): 0 outside the disc and in a plain sky.
  vec3 disc(const dvec3& direction) const { return glsl::scarp_sun_disc(numbers_, direction); }
  /// Light of the sky on level ground.
  vec3 skylight() const { return skylight_; }
  /// Light of the sun on a surface that faces it.
  vec3 sunlight() const { return sunlight_; }
  const glsl::ScarpSky& numbers() const { return numbers_; }

 private:
  void scatter(double turbidity, double sun_radius);

  glsl::ScarpSky numbers_{};
  vec3 skylight_, sunlight_;
};

}  // namespace scarp
